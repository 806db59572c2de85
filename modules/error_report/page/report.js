/* Builds the sections of the page in order, and starts when all files are loaded. */
(function () {
	"use strict";

	const report = window.GnomonReport;
	const make = report.make;
	const root = document.documentElement;
	const ERROR_LABEL = "penumbra MAE";
	// Many programs could afford up to three times the time of the baseline.
	const AFFORDABLE_RATIO = 3;
	const PLOT_HEIGHT_PX = { overview: 440, configuration: 270, scaling: 320 };

	function fillHeader(data) {
		const sizes = new Set(report.matrix.map((item) => item.size_px?.join(" × ")).filter((text) => text));
		const facts = data.machines.flatMap((machine, index) => [
			[data.machines.length > 1 ? `machine ${index + 1}` : "device", `${machine.device}, driver ${machine.driver}`],
			["CPU", `${machine.cpu}, ${machine.threads} threads`]]);
		facts.push(["images", `${[...sizes].join(", ") || "–"} pixels`], ["reference", `${data.samples} samples per pixel`],
			["measured", `${report.matrix.length} configurations`]);
		document.getElementById("facts").append(...facts.map(([name, value]) => make("div", {}, make("dt", {}, name), make("dd", {}, value))));
		const warning = report.makeWarning(data);
		if (warning) {
			document.getElementById("warning").append(warning);
		}
	}

	function describeRow(row) {
		return [report.getSetting(row), `MAE ${report.showError(row.penumbra_mae)}, bias ${report.showBias(row.penumbra_bias)}`,
			`${report.showMs(row.cost_ms)} ms, ${report.showRatio(row.time_ratio)} the baseline`, `${row.configuration_count} configurations`];
	}

	function describeCell(cell) {
		const machine = report.data.machines.length > 1 ? [`machine ${cell.machine + 1}`] : [];
		return [report.getSetting(cell), `MAE ${report.showError(report.getMae(cell))}`,
			`${report.showMs(report.getCostMs(cell))} ms, ${report.showRatio(cell.time_ratio)} the baseline`, ...machine];
	}

	function makeTile(title, row) {
		return row ? make("div", { class: "tile" }, make("h3", {}, title), report.makeName(row), make("p", {}, report.getSetting(row)),
			make("p", {}, make("b", {}, report.showError(row.penumbra_mae)), " MAE at ", make("b", {}, `${report.showMs(row.cost_ms)} ms`),
				` (${report.showRatio(row.time_ratio)})`)) : null;
	}

	function makeRanking(data) {
		const rows = data.ranking.filter((row) => report.isNumber(row.penumbra_mae) && row.cost_ms > 0);
		const section = report.makeSection("ranking", "Ranking over all scenes");
		if (rows.length === 0) {
			section.append(make("p", { class: "soft" }, "Nothing is measured yet."));
			return section;
		}
		const maxCount = report.getMaxConfigurationCount(rows);
		const full = rows.filter((row) => row.configuration_count === maxCount);
		const least = (list) => d3.least(list, (row) => row.penumbra_mae);
		const baseline = full.find((row) => row.technique === report.baseline?.id);
		const affordable = least(full.filter((row) => row.time_ratio <= AFFORDABLE_RATIO));
		const isNew = affordable !== baseline && affordable !== least(full);
		const tiles = make("div", { class: "tiles" }, makeTile("Least error", least(full)),
			isNew ? makeTile(`Least error within ${AFFORDABLE_RATIO}× the baseline's time`, affordable) : null, makeTile("Baseline", baseline));
		const host = make("div", { class: "plot-host", "--height": `${PLOT_HEIGHT_PX.overview}px` });
		let key = "cost_ms";
		const draw = () => {
			const floor = report.getErrorFloor(rows.map((row) => row.penumbra_mae));
			const points = rows.filter((row) => row[key] > 0).map((row) => ({ x: row[key], y: Math.max(floor, row.penumbra_mae),
				technique: row.technique, is_hollow: row.configuration_count < maxCount, item: row }));
			if (points.length === 0) {
				host.replaceChildren(make("p", { class: "soft" }, "No times relative to the baseline."));
				return;
			}
			report.drawPlot(host, { points, front: report.computeFront(points.filter((point) => !point.is_hollow)), labels: "best",
				x_label: key === "cost_ms" ? "median cost, ms" : "median cost, × baseline", y_label: ERROR_LABEL,
				x_domain: report.getDomain(points.map((point) => point.x)), y_domain: report.getDomain(points.map((point) => point.y), true),
				height_px: PLOT_HEIGHT_PX.overview, describe: (point) => describeRow(point.item), name: "Error against time, all scenes" });
		};
		const choice = report.makeChoice("Horizontal axis", [["cost_ms", "milliseconds"], ["time_ratio", "× baseline"]], key, (value) => {
			key = value;
			draw();
		});
		const partial = full.length < rows.length ? make("p", { class: "soft" }, "Hollow dots and marked rows: measured in fewer " +
			`than ${maxCount} configurations, so their means are over other images. They are not part of the Pareto front and the values next to it.`) : null;
		report.add(section, make("div", { class: "overview" }, make("div", {}, make("div", { class: "bar-line" },
			make("p", { class: "soft" }, "One dot per setting. Lower is closer to the reference, further left is faster."), choice), host), tiles),
		partial, report.makeRankingTable("All settings, means over configurations", data.ranking),
		data.best_settings.length > 0 && data.best_settings.length < data.ranking.length ? report.makeRankingTable("Best setting chosen for each configuration", data.best_settings) : null);
		drawOnEverySize(host, draw);
		return section;
	}

	/* Creates the two lit images of a scene: with the shadows of all its lights, and without shadows. */
	function makeSceneImages(scene) {
		const shown = (report.data.scene_images || []).filter((item) => item.scene === scene && report.data.images[item.image]);
		return make("div", { class: "scene-images" }, shown.map((item) => {
			const what = item.has_shadows ? "with the shadows of its lights" : "without shadows";
			return make("figure", {}, make("img", { src: report.data.images[item.image], alt: `${scene} ${what}`, loading: "lazy" }),
				make("figcaption", { class: "soft" }, what));
		}));
	}

	function makeScene(scene, configurations, index) {
		const cells = configurations.flatMap((item) => item.cells);
		const drawn = cells.filter(report.isDrawn);
		const first = configurations[0];
		const lightCount = new Set(configurations.map((item) => item.light)).size;
		const section = report.makeSection(`scene-${index}`, scene, make("p", { class: "soft" }, `${report.showCount(first.triangles)} triangles, ` +
			`${lightCount} ${lightCount === 1 ? "light" : "lights"}. All plots of a scene have the same axes. A click on a dot shows its image below.`));
		section.classList.add("scene");
		section.append(makeSceneImages(scene));
		const plots = [];
		let chosen = null;
		const floor = report.getErrorFloor(drawn.map(report.getMae));
		const toY = (cell) => Math.max(floor, report.getMae(cell));
		const x_domain = drawn.length > 0 && report.getDomain(drawn.map(report.getCostMs));
		const y_domain = drawn.length > 0 && report.getDomain(drawn.map(toY), true);
		const viewer = cells.length > 0 ? report.makeViewer(configurations.filter((item) => item.cells.length > 0), (cell) => {
			chosen = cell;
			plots.forEach((plot) => plot.mark(cell));
		}) : null;
		const grid = make("div", { class: "grid" }, configurations.map((configuration) => {
			const own = configuration.cells.filter(report.isDrawn);
			const reference = configuration.reference_mask ? `${report.showCount(configuration.penumbra_pixels)} penumbra pixels, reference ± ${report.showError(configuration.reference_mask.standard_error)}` : "";
			const figure = make("figure", {}, make("h3", {}, report.getLightText(configuration)), make("p", { class: "soft" }, reference));
			if (own.length === 0) {
				figure.append(make("p", { class: configuration.status === "failed" ? "failure" : "soft" },
					configuration.status === "failed" ? `Failed: ${configuration.message || "no message"}` : "Not measured."));
				return figure;
			}
			const toPoint = (cell) => ({ x: report.getCostMs(cell), y: toY(cell), technique: cell.technique, item: cell,
				is_hollow: report.getMae(cell) < floor });
			const host = make("div", { class: "plot-host", "--height": `${PLOT_HEIGHT_PX.configuration}px` });
			report.add(figure, host, makePlotNote(configuration, own, floor));
			const slot = plots.push({ mark: () => {} }) - 1;
			drawOnEverySize(host, () => {
				plots[slot] = report.drawPlot(host, { points: own.map(toPoint), x_label: "cost, ms", y_label: ERROR_LABEL, x_domain, y_domain,
					front: (configuration.pareto || []).map((cell) => toPoint(report.data.cells[cell])), height_px: PLOT_HEIGHT_PX.configuration,
					describe: (point) => describeCell(point.item), onPick: viewer.select, name: `Error against time, ${configuration.id}` });
				plots[slot].mark(chosen);
			});
			return figure;
		}));
		section.append(grid);
		if (viewer) {
			section.append(viewer.element);
			const start = configurations.find((item) => item === configurations[configurations.length >> 1] && item.pareto?.length > 0) ||
				configurations.find((item) => item.pareto?.length > 0);
			// Initially shows the middle of a Pareto front: a plausible setting whose error is visible.
			report.drawWhenNear(viewer.element, () => viewer.select(
				chosen || (start ? report.data.cells[start.pareto[start.pareto.length >> 1]] : cells[0])));
		}
		return section;
	}

	function makePlotNote(configuration, drawn, floor) {
		const notes = [];
		if (drawn.some((cell) => report.getMae(cell) < floor)) {
			notes.push(`Hollow: an error of 0, or below ${report.showPlain(floor)}, is drawn there.`);
		}
		const absent = configuration.cells.filter((cell) => !report.isDrawn(cell));
		if (absent.length > 0) {
			notes.push(`Not drawn: ${absent.map((cell) => `${report.getTechnique(cell.technique).name}, ${report.getSetting(cell)} (${cell.status})`).join("; ")}.`);
		}
		return notes.length > 0 ? make("p", { class: "soft note" }, notes.join(" ")) : null;
	}

	function makeScaling(data) {
		const section = report.makeSection("scaling", "Scaling", make("p", { class: "soft" }, data.scaling.length === 0
			? "Not measured; run with --scaling" : "Cost of each technique with its default setting, on generated scenes."));
		const curves = data.scaling.map((curve) => ({ ...curve, points: (curve.series || []).flatMap((series) => (series.points || [])
			.filter((point) => point.value > 0 && point.cost_ms > 0)
			.map((point) => ({ x: point.value, y: point.cost_ms, technique: series.technique, item: point }))) }));
		section.append(make("div", { class: "grid two" }, curves.map((curve) => {
			const name = curve.name.replaceAll("_", " ");
			const x_label = curve.unit && curve.unit !== name ? `${name}, ${curve.unit}` : name;
			const host = make("div", { class: "plot-host", "--height": `${PLOT_HEIGHT_PX.scaling}px` });
			const figure = make("figure", {}, make("h3", {}, `Time against ${name}`), host);
			if (curve.points.length === 0) {
				host.replaceWith(make("p", { class: "soft" }, "Not measured."));
				return figure;
			}
			drawOnEverySize(host, () => report.drawPlot(host, { points: curve.points, x_label, y_label: "cost, ms", labels: "end",
				x_domain: report.getDomain(curve.points.map((point) => point.x)), y_domain: report.getDomain(curve.points.map((point) => point.y)),
				height_px: PLOT_HEIGHT_PX.scaling, name: `Time against ${name}`,
				describe: (point) => [`${report.showTick(point.x)} ${curve.unit || ""}`, `${report.showMs(point.y)} ms`] }));
			return figure;
		})));
		return section;
	}

	const DEFINITIONS = [
		["Visibility", "The fraction of the light that a receiver sees: 0 hidden, 1 lit. Penumbra pixels are those with a reference visibility between 0.002 and 0.998."],
		["Error", "Visibility of the technique minus that of the reference, a ray-traced area light. Negative: too dark. Positive: too light."],
		["MAE, RMSE", "Mean absolute error; root of the mean squared error. Over penumbra pixels if nothing else is stated."],
		["Bias", "Mean signed error. Near 0 does not mean correct: too dark and too light cancel."],
		["p99", "99 of 100 pixels have a smaller absolute error."],
		["Wrong", "The fraction of the pixels whose absolute error exceeds 0.2."],
		["Umbra over-estimation", "Of the penumbra pixels that see more than 5 % of the light, the fraction that is shown with less than 1 %."],
		["Whole light", "Errors over only the receivers that have the whole light above their own horizon."],
		["cost_ms", "Time of the light's own passes, each submitted alone, median over frames: GPU time, or wall time of passes on the CPU. Nothing is cached between frames."],
		["Baseline", "× baseline is cost_ms over that of the baseline technique in the same configuration and run."],
		["Pareto front", "The settings that no other setting beats in both error and time."],
	];

	function fillFoot(data) {
		const techniques = data.techniques.map((technique) => [technique.id, `${technique.name}. Source: ${technique.source}.`]);
		document.getElementById("foot").append(report.makeSection("how", "How to read this",
			make("dl", { class: "definitions" }, [...DEFINITIONS, ...techniques].flatMap(([name, text]) =>
				[make("dt", {}, name), make("dd", {}, text)]))),
		make("p", { class: "soft" }, `Gnomon ${data.program || ""}, project ${data.project || ""}`));
	}

	/* Calls draw when host is near the viewport, and again after the window's width has changed, since a plot has a fixed width. */
	const sized = [];
	function drawOnEverySize(host, draw) {
		sized.push([host, draw]);
		report.drawWhenNear(host, draw);
	}

	let width_px = window.innerWidth;
	let timer = 0;
	/* Stores by how many pixels the page is wider than the window, for tests. */
	function reportOverflow() {
		root.dataset.overflow = root.scrollWidth - root.clientWidth;
	}
	window.addEventListener("resize", () => {
		clearTimeout(timer);
		// Redraws only if the width changed: phones also send this event when their toolbar appears or disappears.
		timer = width_px === window.innerWidth ? 0 : setTimeout(() => {
			width_px = window.innerWidth;
			sized.forEach(([host, draw]) => report.drawWhenNear(host, draw));
			reportOverflow();
		}, 150);
	});

	async function start() {
		const data = report.load();
		const main = document.getElementById("report");
		fillHeader(data);
		report.fillLegend(document.getElementById("legend"));
		const scenes = d3.groups(report.matrix, (item) => item.scene);
		const sections = [makeRanking(data), report.makeBudget(data),
			...scenes.map(([scene, configurations], index) => makeScene(scene, configurations, index)), makeScaling(data)];
		report.parts.forEach((makeSection, id) => sections.push(makeSection(data[id], drawOnEverySize)));
		const against = report.makeAgainst(data.against);
		if (against) {
			sections.push(report.makeSection("against", "Against the other report", against));
		}
		main.append(...sections);
		fillFoot(data);
		document.getElementById("contents").append(...[...document.querySelectorAll("section")]
			.map((section) => make("a", { href: `#${section.id}`, class: section.id.startsWith("scene-") ? "scene-link" : null },
				section.getAttribute("aria-label"))));
		window.addEventListener("beforeprint", () => report.drawAll());
		if (location.hash === "#all") {
			await report.drawAll();
		} else {
			// The browser handled the URL's fragment before the section existed.
			document.getElementById(decodeURIComponent(location.hash.slice(1)))?.scrollIntoView();
		}
		reportOverflow();
		root.dataset.ready = "yes";
	}

	document.addEventListener("DOMContentLoaded", () => start().catch((error) => {
		root.dataset.ready = "failed";
		document.body.prepend(make("p", { id: "fatal", class: "fatal", role: "alert" },
			`This report cannot be shown: ${error.message} Make it again with gnomon report.`));
	}));
})();

/* The section "Stability": a plot for each sweep, tables of where each technique breaks, and tables of the hostile scenes. */
(function () {
	"use strict";

	const report = window.GnomonReport;
	const make = report.make;
	const PLOT_HEIGHT_PX = 300;
	const STATES = {
		ok: "holds", doubled: "more than twice the centre's error", nonsense: "light where all is dark, or shadow where all is lit",
		refused: "refused, with a message", failed: "failed", missing: "not measured",
	};
	const getPoints = (plot) => plot.series.flatMap((series) => series.points.map((point) => ({ ...point, technique: series.technique })));
	const getCell = (point) => report.data.cells[point.cell];
	/* Returns the quantity of the sweep, with the unit S, if it ends with it, spelled out. */
	const showQuantity = (plot) => plot.quantity.replace(/,? ?S$/, (unit) => (unit ? ", of the scene's size S" : ""));

	function describe(point) {
		const cell = getCell(point);
		const lines = [`at ${point.label}: ${STATES[point.state]}`];
		if (report.isNumber(point.mae)) {
			lines.push(`MAE ${report.showError(point.mae)} over ${point.is_of_penumbra ? "the penumbra" : "all receivers"}`);
		}
		const stability = cell.stability || {};
		if (report.isNumber(stability.temporal_rmse)) {
			lines.push(`error of change under motion ${stability.temporal_rmse.toExponential(1)}`);
		}
		if (stability.wrong_share > 0) {
			lines.push(`${report.showPercent(stability.wrong_share)} of the receivers plainly wrong`);
		}
		if (stability.condition) {
			lines.push(`cause: ${stability.condition.cause}; condition number ${report.showPlain(stability.condition.number)}`);
		}
		lines.push(...(stability.warnings || []).map((warning) => `warned: ${warning}`));
		return [...lines, ...[stability.refusal, cell.message].filter((text) => text)];
	}

	/* Values are evenly spaced, whatever their distances: the plot's x axis is logarithmic, so x is 2 to the power of the index. */
	function drawSweep(host, plot, onPick) {
		const labels = [...new Set(plot.series.flatMap((series) => series.points.map((point) => point.label)))];
		const drawn = getPoints(plot).filter((point) => report.isNumber(point.mae));
		if (drawn.length === 0) {
			host.replaceChildren(make("p", { class: "soft" }, "Nothing was drawn."));
			return;
		}
		const floor = report.getErrorFloor(drawn.map((point) => point.mae));
		const points = drawn.map((point) => ({ x: 2 ** labels.indexOf(point.label), y: Math.max(floor, point.mae),
			technique: point.technique, is_hollow: point.state !== "ok", item: point }));
		report.drawPlot(host, { points, x_label: showQuantity(plot), y_label: "MAE", height_px: PLOT_HEIGHT_PX, labels: null,
			x_ticks: labels.map((label, index) => [2 ** index, label]), x_domain: [2 ** -0.4, 2 ** (labels.length - 0.6)],
			y_domain: report.getDomain(points.map((point) => point.y)), describe: (point) => describe(point.item),
			onPick: (item) => onPick(getCell(item)), name: `Error against ${plot.quantity}, ${plot.light_type}` });
	}

	function makeSweep(plots, onPick, drawOnEverySize) {
		const host = make("div", { class: "plot-host", "--height": `${PLOT_HEIGHT_PX}px` });
		let shown = plots[0];
		const draw = () => drawSweep(host, shown, onPick);
		const choice = plots.length > 1 ? report.makeChoice("Type of the light", plots.map((plot) => [plot, plot.light_type]), shown, (plot) => {
			shown = plot;
			draw();
		}) : null;
		const figure = make("figure", {}, make("h3", {}, plots[0].sweep.replaceAll("_", " ")),
			make("p", { class: "soft" }, `${showQuantity(plots[0])}; centre ${plots[0].center}`), choice, host);
		drawOnEverySize(host, draw);
		return figure;
	}

	function showBreaks(series) {
		if (!series) {
			return "–";
		}
		if (series.break_before && series.break_before === series.break_after) {
			return "not at its centre";
		}
		const ends = [series.break_before, series.break_after].filter((label) => label);
		return ends.map((label) => `from ${label}`).join(" and ") || (series.is_complete ? "holds" : "?");
	}

	/* Creates a table with one row per technique and one column per sweep: the first value at which the technique fails. */
	function makeBreaks(plots) {
		const ids = [...new Set(plots.flatMap((plot) => plot.series.map((series) => series.technique)))];
		const find = (plot, id) => plot.series.find((series) => series.technique === id);
		const columns = [{ title: "technique", isText: true, value: (id) => id, show: (id) => report.makeName({ technique: id }) },
			...plots.map((plot) => ({ title: plot.sweep.replaceAll("_", " "), help: showQuantity(plot), isText: true,
				value: (id) => showBreaks(find(plot, id)), show: (id) => showBreaks(find(plot, id)) }))];
		return report.makeTable(`Where each technique breaks, ${plots[0].light_type}`, columns, ids, -1);
	}

	/* Creates a table of separate scenes: one row per scene, one column per technique. */
	function makeCases(plot) {
		const labels = plot.series[0].points.map((point) => point.label);
		const find = (label, id) => plot.series.find((series) => series.technique === id)?.points.find((point) => point.label === label);
		const show = (point) => (!point ? "–" : point.state !== "ok" && !report.isNumber(point.mae) ? point.state
			: make("span", { class: point.state === "ok" ? null : "mark", title: describe(point).join("; ") }, report.showError(point.mae)));
		const columns = [{ title: "scene", isText: true, value: (label) => label, show: (label) => label },
			...plot.series.map((series) => ({ title: series.technique, help: report.getTechnique(series.technique).name,
				value: (label) => find(label, series.technique)?.mae, show: (label) => show(find(label, series.technique)) }))];
		const title = plot.quantity[0].toUpperCase() + plot.quantity.slice(1);
		return report.makeTable(`${title}, ${plot.light_type}: MAE`, columns, labels, -1);
	}

	/* plots: report.json's "stability". */
	report.parts.set("stability", (plots, drawOnEverySize) => {
		const section = report.makeSection("stability", "Stability");
		if (plots.length === 0) {
			return report.add(section, make("p", { class: "soft" }, "Not measured; run with --stability."));
		}
		const curves = plots.filter((plot) => !plot.has_cases);
		const points = plots.flatMap(getPoints);
		const counts = d3.rollups(points, (list) => list.length, (point) => point.state);
		section.append(make("p", { class: "soft" }, `Generated scenes, each with one thing taken from harmless to extreme. ${report.showCount(points.length)} points: ` +
			`${counts.map(([state, count]) => `${report.showCount(count)} ${state}`).join(", ")}. Hollow dots do not hold: their error is more than twice ` +
			"that of the sweep's centre, or the image is nonsense. A click on a dot shows its image, where the report keeps it."));
		const withImages = report.data.configurations.filter((item) => item.group === "stability" && item.cells.some((cell) => cell.image));
		const showPoint = (item) => `${item.id.split("/").slice(1).join(", ").replaceAll("_", " ")}`;
		const viewer = withImages.length > 0 ? report.makeViewer(withImages, () => {}, showPoint) : null;
		const onPick = (cell) => (cell.image ? viewer?.select(cell) : undefined);
		section.append(make("div", { class: "grid two" }, d3.groups(curves, (plot) => plot.sweep)
			.map(([, list]) => makeSweep(list, onPick, drawOnEverySize))));
		if (viewer) {
			section.append(viewer.element);
			report.drawWhenNear(viewer.element, () => viewer.select(withImages[0].cells.find((cell) => cell.image)));
		}
		section.append(...d3.groups(curves, (plot) => plot.light_type).map(([, list]) => makeBreaks(list)),
			...plots.filter((plot) => plot.has_cases).map(makeCases));
		return section;
	});
})();

/* The image viewer of a scene: result against reference, the signed error, and the numbers of one cell. Images are
   decoded when they are shown, because a report can hold several hundred. */
(function () {
	"use strict";

	const report = window.GnomonReport;
	const make = report.make;
	// Enough that going back and forth between a few cells, with two images each, does not decode again.
	const CACHED_IMAGE_COUNT = 16;
	const SHOWN_PASS_COUNT = 6;
	const images = new Map();

	/* Returns a promise of { width, height, data: RGBA bytes } of an embedded image; null if no image has that name. */
	function loadPixels(name) {
		const url = report.data.images[name];
		if (!url) {
			return Promise.resolve(null);
		}
		if (!images.has(name)) {
			images.set(name, new Promise((resolve, reject) => {
				const image = new Image();
				image.onload = () => {
					const canvas = make("canvas", { width: image.naturalWidth, height: image.naturalHeight });
					const context = canvas.getContext("2d", { willReadFrequently: true });
					context.drawImage(image, 0, 0);
					resolve(context.getImageData(0, 0, canvas.width, canvas.height));
				};
				image.onerror = () => reject(new Error(`The image ${name} cannot be decoded.`));
				image.src = url;
			}));
			if (images.size > CACHED_IMAGE_COUNT) {
				images.delete(images.keys().next().value);
			}
		}
		return images.get(name);
	}

	/* Returns [r, g, b], 0 to 255, of a signed error, interpolated in the heat map's colours. */
	function getHeatColor(error) {
		const { range, colors } = report.data.heat_map;
		const position = (Math.max(-1, Math.min(1, error / range)) + 1) / 2 * (colors.length - 1);
		const low = Math.floor(position);
		const high = Math.min(low + 1, colors.length - 1);
		return colors[low].map((value, channel) => value + (colors[high][channel] - value) * (position - low));
	}

	/* Fills a canvas. getColor(offset of the pixel's first byte) returns [r, g, b, a]. */
	function paint(canvas, size, getColor) {
		canvas.width = size.width;
		canvas.height = size.height;
		const context = canvas.getContext("2d");
		const image = context.createImageData(size.width, size.height);
		for (let offset = 0; offset < image.data.length; offset += 4) {
			image.data.set(getColor(offset), offset);
		}
		context.putImageData(image, 0, 0);
	}

	/* Merges passes whose names differ only in digits: the same work for several views or layers. Returns the most expensive
	   passes, descending, and the sum of the others. */
	function mergePasses(passes) {
		const merged = new Map();
		for (const pass of passes || []) {
			const key = pass.name.replace(/\d+/g, "N");
			const entry = merged.get(key) || { name: pass.name, cost_ms: 0, count: 0 };
			entry.cost_ms += pass.is_on_host ? pass.wall_ms : pass.gpu_ms;
			entry.count += 1;
			entry.name = entry.count > 1 ? `${key.replaceAll(/ ?N/g, "")} (${entry.count})` : pass.name;
			merged.set(key, entry);
		}
		const sorted = [...merged.values()].sort((a, b) => b.cost_ms - a.cost_ms);
		const rest = sorted.slice(SHOWN_PASS_COUNT);
		// A single remaining pass is listed by name, since "1 others" saves no space.
		return rest.length < 2 ? sorted
			: [...sorted.slice(0, SHOWN_PASS_COUNT), { name: `${rest.length} others`, cost_ms: d3.sum(rest, (pass) => pass.cost_ms) }];
	}

	function makePasses(cell) {
		const passes = mergePasses(cell.time?.passes);
		const total_ms = d3.sum(passes, (pass) => pass.cost_ms);
		if (!(total_ms > 0)) {
			return [];
		}
		const color = report.getTechnique(cell.technique).color;
		const getShade = (index) => `color-mix(in srgb, ${color} ${100 * 0.76 ** index}%, var(--card))`;
		const bar = make("div", { class: "pass-bar", "aria-hidden": "true" }, passes.map((pass, index) => make("i", {
			title: `${pass.name}: ${report.showMs(pass.cost_ms)} ms`, "--part": pass.cost_ms / total_ms, "--shade": getShade(index),
		})));
		const list = make("ul", { class: "pass-list" }, passes.map((pass, index) => make("li", {},
			make("i", { "--shade": getShade(index) }), make("span", {}, pass.name),
			make("b", {}, `${report.showMs(pass.cost_ms)} ms`), make("em", {}, report.showPercent(pass.cost_ms / total_ms)))));
		return [make("h4", {}, "Time by pass"), bar, list];
	}

	function makeMetrics(cell) {
		const penumbra = cell.error?.all?.penumbra || {};
		const receiver = cell.error?.all?.receiver || {};
		const time = cell.time || {};
		const entries = [
			["penumbra MAE", report.showError(penumbra.mae)], ["RMSE", report.showError(penumbra.rmse)],
			["p99", report.showError(penumbra.p99)], ["bias", report.showBias(penumbra.bias)],
			["wrong", report.showPercent(penumbra.wrong)], ["umbra over", report.showPercent(penumbra.umbra_over)],
			["all receivers", report.showError(receiver.mae)], ["wrong, receivers", report.showPercent(receiver.wrong)],
			["whole light", report.showError(report.getWholeLight(cell)?.penumbra?.mae)],
			...(cell.time ? [["cost", `${report.showMs(time.cost_ms)} ms (${report.showRatio(cell.time_ratio)})`],
				["memory", report.showMebibytes(cell.bytes)]] : []),
		];
		return entries.map(([name, value]) => make("span", {}, `${name} `, make("b", {}, value)));
	}

	report.makeHeatLegend = function () {
		const { range, colors } = report.data.heat_map;
		const stops = d3.range(9).map((step) => colors[Math.round(step / 8 * (colors.length - 1))]);
		const gradient = `linear-gradient(90deg, ${stops.map((color) => `rgb(${color.join(",")})`).join(", ")})`;
		return make("div", { class: "heat-legend" }, make("span", {}, `−${range} too dark`), make("i", { "--ramp": gradient }),
			make("span", {}, `+${range} too light`));
	};

	function makeSelect(label, onChange) {
		const select = make("select", { onchange: () => onChange(Number(select.value)) });
		return { select, element: make("label", { class: "field" }, make("span", {}, label), select) };
	}

	/* Creates a viewer: { element, select(cell) }. onSelect(cell) is called for each selected cell, whether selected in the
	   viewer or by select. getLabel(configuration) is its name in the list. */
	report.makeViewer = function (configurations, onSelect, getLabel = report.getLightText) {
		const referenceCanvas = make("canvas", { "aria-hidden": "true" });
		const resultCanvas = make("canvas", { class: "over", "aria-hidden": "true" });
		const heatCanvas = make("canvas", { role: "img", "aria-label": "Signed error, result minus reference" });
		const slider = make("input", { type: "range", min: 0, max: 100, value: 50, "aria-label": "Wipe between result and reference",
			oninput: () => wipe.style.setProperty("--x", `${slider.value}%`) });
		const wipe = make("div", { class: "wipe", "--x": "50%" }, referenceCanvas, resultCanvas, make("i"),
			make("b", { class: "left" }, "result"), make("b", { class: "right" }, "reference"), slider);
		const probe = make("p", { class: "probe" });
		const message = make("p", { class: "failure", hidden: true });
		const metrics = make("p", { class: "metrics" });
		const passes = make("div", { class: "passes" });
		const views = make("div", { class: "views" },
			make("figure", {}, wipe, make("figcaption", {}, "Result and reference: drag to wipe. Hatched: no receiver.")),
			make("figure", {}, make("div", { class: "heat" }, heatCanvas), report.makeHeatLegend(), probe), passes);
		const chooseConfiguration = makeSelect("light and size", (index) => select(findMatchingCell(configurations[index])));
		const chooseCell = makeSelect("technique and setting", (index) => select(report.data.cells[index]));
		configurations.forEach((configuration, index) => chooseConfiguration.select.append(
			make("option", { value: index }, getLabel(configuration))));
		const element = make("div", { class: "viewer" },
			make("div", { class: "fields" }, chooseConfiguration.element, chooseCell.element), metrics, message, views);
		let chosen = null;
		let shown = null;

		/* Returns the cell of another configuration with the chosen technique and setting, else with the technique, else the first. */
		function findMatchingCell(configuration) {
			const cells = configuration.cells;
			return cells.find((cell) => cell.technique === chosen?.technique && cell.setting === chosen.setting) ||
				cells.find((cell) => cell.technique === chosen?.technique) || cells[0];
		}

		function select(cell) {
			const configuration = report.data.configurations[cell.configuration];
			if (!chosen || chosen.configuration !== cell.configuration) {
				chooseConfiguration.select.value = configurations.indexOf(configuration);
				chooseCell.select.replaceChildren(...[...d3.group(configuration.cells, (item) => item.technique)].map(
					([id, cells]) => make("optgroup", { label: report.getTechnique(id).name }, cells.map((item) => make("option",
						{ value: item.index }, `${report.getTechnique(id).name}, ${report.getSetting(item)}`)))));
			}
			chosen = cell;
			chooseCell.select.value = cell.index;
			metrics.replaceChildren(...(cell.status === "ok" ? makeMetrics(cell) : []));
			passes.replaceChildren(...makePasses(cell));
			onSelect(cell);
			return draw();
		}

		async function draw() {
			const cell = chosen;
			const referenceName = report.data.configurations[cell.configuration].reference_mask?.image;
			try {
				const [result, reference] = await Promise.all([loadPixels(cell.image), loadPixels(referenceName)]);
				if (cell === chosen) {
					showPixels(cell, result, reference);
				}
			} catch (error) {
				showMessage(error.message);
			}
		}

		function showMessage(text) {
			message.textContent = text;
			message.hidden = !text;
			views.classList.toggle("empty", Boolean(text));
		}

		function showPixels(cell, result, reference) {
			probe.textContent = "";
			shown = null;
			if (cell.status !== "ok") {
				return showMessage(cell.status === "missing" ? "Not measured." : `Failed: ${cell.message || "no message"}`);
			}
			if (!result || !reference) {
				return showMessage("This cell has no image in this page.");
			}
			if (result.width !== reference.width || result.height !== reference.height) {
				return showMessage("Result and reference differ in size.");
			}
			showMessage("");
			const range = report.data.heat_map.range;
			const toGrey = (pixels) => (offset) => [pixels.data[offset], pixels.data[offset], pixels.data[offset],
				reference.data[offset + 3] > 0 ? 255 : 0];
			const getError = (offset) => (result.data[offset] - reference.data[offset]) / 255;
			// There are only 511 possible differences, so their colours are computed once.
			const table = d3.range(-255, 256).map((step) => [...getHeatColor(step / 255).map(Math.round), 255]);
			const grey = report.data.heat_map.no_receiver;
			paint(resultCanvas, reference, toGrey(result));
			paint(referenceCanvas, reference, toGrey(reference));
			paint(heatCanvas, reference, (offset) => (reference.data[offset + 3] > 0
				? table[result.data[offset] - reference.data[offset] + 255] : [grey, grey, grey, 255]));
			views.style.setProperty("--aspect", `${reference.width} / ${reference.height}`);
			shown = { result, reference, getError, range };
			return undefined;
		}

		/* Shows the values of the pixel under the pointer. */
		function showProbe(event) {
			if (!shown) {
				return;
			}
			const { result, reference, getError } = shown;
			const box = event.currentTarget.getBoundingClientRect();
			const clamp = (value, size) => Math.max(0, Math.min(size - 1, Math.floor(value * size)));
			const x_px = clamp((event.clientX - box.left) / box.width, reference.width);
			const y_px = clamp((event.clientY - box.top) / box.height, reference.height);
			const offset = 4 * (y_px * reference.width + x_px);
			const values = reference.data[offset + 3] === 0 ? "no receiver" : `result ${(result.data[offset] / 255).toFixed(3)}, ` +
				`reference ${(reference.data[offset] / 255).toFixed(3)}, error ${report.showBias(getError(offset))}`;
			probe.textContent = `pixel ${x_px}, ${y_px}: ${values}`;
		}
		[wipe, heatCanvas].forEach((item) => item.addEventListener("pointermove", showProbe));

		return { element, select };
	};
})();

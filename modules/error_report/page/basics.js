/* Shared by all files of the page: loading the data, formatting numbers, and creating elements. The files are joined in
   alphabetical order, those of report parts last, so this one comes first and defines GnomonReport, the only global. */
(function () {
	"use strict";

	const report = {};
	window.GnomonReport = report;
	/* The sections of report parts, in the order of the page: by the part's key in report.json a function that is called with the
	   value of that key and drawOnEverySize (report.js), and returns the section. */
	report.parts = new Map();

	// Filled symbols of d3 that are distinguishable at 9 pixels. Shapes distinguish techniques of similar colour.
	const SYMBOLS = ["circle", "square", "triangle", "diamond", "star", "cross", "wye"];
	const NO_VALUE = "–";

	/* Creates an element. Attributes that start with "--" are style properties, those with "on" are event listeners. null and
	   undefined attributes and children are skipped. Strings become text, never markup. */
	report.make = function (tag, attributes, ...children) {
		const element = document.createElement(tag);
		for (const [name, value] of Object.entries(attributes || {})) {
			if (value === null || value === undefined || value === false) {
				continue;
			}
			if (name.startsWith("--")) {
				element.style.setProperty(name, value);
			} else if (name.startsWith("on")) {
				element.addEventListener(name.slice(2), value);
			} else {
				element.setAttribute(name, value === true ? "" : value);
			}
		}
		return report.add(element, ...children);
	};

	/* Appends children, like make, and returns the element. */
	report.add = function (element, ...children) {
		element.append(...children.flat().filter((child) => child !== null && child !== undefined));
		return element;
	};

	/* Parses the embedded report.json, adds indices and the cells of each configuration, and sets report.data,
	   report.techniques (by id), report.baseline and report.matrix. */
	report.load = function () {
		const data = JSON.parse(document.getElementById("report-data").textContent);
		if (data.format !== "gnomon_report" || data.version !== 2) {
			throw new Error(`The data is "${data.format}" version ${data.version}, must be "gnomon_report" version 2.`);
		}
		for (const key of ["configurations", "cells", "techniques", "ranking", "best_settings", "scaling", "machines"]) {
			data[key] = data[key] || [];
		}
		data.images = data.images || {};
		report.data = data;
		report.techniques = new Map();
		// Techniques are labelled by id: it fits on a phone and is what the command line takes. The footer lists the names.
		data.techniques.forEach((technique) => addTechnique(technique.id, technique.id, technique.color));
		// Techniques that only occur in cells, because they are no longer registered, get a default colour.
		[...data.cells, ...data.ranking].forEach((item) => addTechnique(item.technique, item.technique, "#888888"));
		data.configurations.forEach((configuration, index) => {
			configuration.index = index;
			configuration.cells = [];
		});
		data.cells.forEach((cell, index) => {
			cell.index = index;
			data.configurations[cell.configuration].cells.push(cell);
		});
		report.baseline = data.techniques.find((technique) => technique.is_baseline);
		report.matrix = data.configurations.filter((configuration) => configuration.group === "matrix");
		return data;
	};

	function addTechnique(id, name, color) {
		if (!report.techniques.has(id)) {
			const index = report.techniques.size;
			report.techniques.set(id, { id, name: name || id, index, color: toTone(color), symbol: SYMBOLS[index % SYMBOLS.length] });
		}
	}

	/* Returns a CSS colour that is lighter on a dark page, see --tone in report.css. */
	function toTone(color) {
		return `color-mix(in srgb, ${color} var(--tone), #fff)`;
	}

	report.isNumber = (value) => typeof value === "number" && Number.isFinite(value);

	/* The two values of a cell that plots show; undefined if the cell failed, is missing or has no reference. */
	report.getMae = (cell) => cell.error?.all?.penumbra?.mae;
	report.getCostMs = (cell) => cell.time?.cost_ms;
	report.isDrawn = (cell) => report.isNumber(report.getMae(cell)) && report.getCostMs(cell) > 0;

	/* The errors over receivers that see the whole light. `as` marks that they equal those over all receivers. */
	report.getWholeLight = (cell) => (cell.error?.whole_light?.as ? cell.error.all : cell.error?.whole_light);

	report.getTechnique = (id) => report.techniques.get(id) || { id, name: id, color: "#888888", index: -1, symbol: "circle" };
	report.getSetting = (item) => item.setting || "default";
	report.getSizeText = (configuration) => configuration.light_type === "directional"
		? `${report.showPlain(configuration.light_angular_distance_deg)}°`
		: `${report.showPlain(configuration.light_size_m)} m`;
	report.getLightText = (configuration) => `${configuration.light}, ${report.getSizeText(configuration)}`;

	/* Wraps a formatter: values that are not finite numbers become a dash. */
	function show(format) {
		return (value) => (report.isNumber(value) ? format(value) : NO_VALUE);
	}

	report.showError = show((value) => (value > 0 && value < 0.0001 ? "< 0.0001" : value.toFixed(4)));
	report.showBias = show((value) => (value < 0 ? "−" : "+") + Math.abs(value).toFixed(4));
	report.showPercent = show((value) => `${(100 * value).toFixed(1)} %`);
	report.showMs = show((value) => value.toFixed(value < 1 ? 3 : value < 10 ? 2 : value < 100 ? 1 : 0));
	report.showRatio = show((value) => `${value.toFixed(value < 10 ? 2 : value < 100 ? 1 : 0)}×`);
	report.showCount = show((value) => value.toLocaleString("en"));
	report.showMebibytes = show((value) => `${(value / 1048576).toFixed(1)} MiB`);
	report.showPlain = show((value) => String(Number(value.toPrecision(4))));
	/* Formats a tick of a logarithmic axis, at most as long as "0.0005" or "500k". */
	report.showTick = (value) => (value >= 10000 ? d3.format("~s")(value) : String(Number(value.toPrecision(3))));

	/* Creates the symbol of a technique, as in plots. */
	report.makeSwatch = function (technique) {
		const svg = d3.create("svg").attr("class", "swatch").attr("viewBox", "-8 -8 16 16").attr("aria-hidden", "true");
		const symbol = d3[`symbol${technique.symbol[0].toUpperCase()}${technique.symbol.slice(1)}`];
		svg.append("path").attr("d", d3.symbol(symbol, 110)()).attr("fill", technique.color);
		return svg.node();
	};

	report.makeName = function (item, className) {
		const technique = report.getTechnique(item.technique);
		return report.make("span", { class: className || "name" }, report.makeSwatch(technique), technique.name);
	};

	report.makeSection = function (id, title, ...children) {
		const heading = report.make("h2", {}, title);
		return report.make("section", { id, "aria-label": title }, heading, ...children);
	};

	/* Creates a group of buttons of which one is pressed. options: [value, text] of each. */
	report.makeChoice = function (label, options, chosen, onChoose) {
		const buttons = options.map(([value, text]) => report.make("button", {
			type: "button", "aria-pressed": String(value === chosen), onclick: () => {
				buttons.forEach((button, index) => button.setAttribute("aria-pressed", String(options[index][0] === value)));
				onChoose(value);
			},
		}, text));
		return report.make("div", { class: "choice", role: "group", "aria-label": label }, buttons);
	};

	/* Deferred drawing: drawWhenNear(element, draw) calls draw once when the element is near the viewport. drawAll() calls
	   all pending functions at once, for printing and tests, see report.js. */
	const waiting = new Map();
	const observer = new IntersectionObserver((entries) => {
		entries.filter((entry) => entry.isIntersecting).forEach((entry) => drawNow(entry.target));
	}, { rootMargin: "500px" });

	function drawNow(element) {
		const draw = waiting.get(element);
		waiting.delete(element);
		observer.unobserve(element);
		return draw ? draw() : undefined;
	}

	report.drawWhenNear = function (element, draw) {
		waiting.set(element, draw);
		observer.observe(element);
	};

	/* Returns a promise that also waits for asynchronous drawing (images). */
	report.drawAll = () => Promise.all([...waiting.keys()].map(drawNow));
})();

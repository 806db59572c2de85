/* Logarithmic plots of points joined by technique: the overview, the configurations and the scaling curves. */
(function () {
	"use strict";

	const report = window.GnomonReport;
	const make = report.make;
	// Lowest error shown: a logarithmic axis has no 0, and smaller errors are noise of the reference and its 8-bit image.
	const MIN_ERROR_FLOOR = 1e-4;
	// Minimum length of an axis, as ln(max / min): on a shorter one differences of a few percent would look large.
	const MIN_LOG_SPAN = Math.log(3);
	const PICK_DISTANCE_PX = 32; // maximum distance of the pointer from the dot that it picks
	const LABELLED_WIDTH_PX = 560; // narrower plots have no labels of techniques
	const MARGIN_PX = { left: 48, right: 14, top: 26, bottom: 38 };
	const LABEL_FONT = "600 12px system-ui, sans-serif";
	const LABEL_HEIGHT_PX = 15;
	const tip = document.getElementById("tip");
	const hidden = new Set();
	const measuring = make("canvas").getContext("2d");

	/* Returns the error at which errors of about 0 are drawn: below all other errors. */
	report.getErrorFloor = function (errors) {
		const positive = errors.filter((error) => error >= MIN_ERROR_FLOOR);
		const least = positive.length > 0 ? d3.min(positive) : MIN_ERROR_FLOOR;
		return positive.length < errors.length ? Math.max(MIN_ERROR_FLOOR, Number((least / 2).toPrecision(2))) : least;
	};

	/* Returns the [min, max] of an axis for these values, with padding. hasFront: more padding below, for the label
	   "Pareto front". */
	report.getDomain = function (values, hasFront) {
		const low = Math.log(d3.min(values));
		const high = Math.log(d3.max(values));
		const widening = Math.max(0, MIN_LOG_SPAN - (high - low)) / 2;
		const padding = 0.07 * Math.max(high - low, MIN_LOG_SPAN);
		return [Math.exp(low - widening - (hasFront ? 2 : 1) * padding), Math.exp(high + widening + padding)];
	};

	/* Returns the densest set of ticks (1, 2, 5, ... per decade) whose labels are at least spacing_px apart. */
	function chooseTicks(domain, length_px, spacing_px) {
		const [low, high] = domain.map(Math.log10);
		const toPx = (value) => (Math.log10(value) - low) / (high - low) * length_px;
		const decades = d3.range(Math.floor(low), Math.ceil(high) + 1);
		const choices = [[1, 1.5, 2, 3, 4, 5, 7], [1, 2, 3, 5], [1, 2, 5], [1, 3], [1]];
		for (const digits of choices) {
			// Parsed from text, since 3 * 10 ** -3 is not exactly 0.003.
			const ticks = decades.flatMap((decade) => digits.map((digit) => Number(`${digit}e${decade}`)))
				.filter((tick) => tick >= domain[0] && tick <= domain[1]);
			if (d3.pairs(ticks).every(([a, b]) => toPx(b) - toPx(a) >= spacing_px)) {
				return ticks;
			}
		}
		return decades.filter((decade) => decade % 2 === 0).map((decade) => 10 ** decade);
	}

	/* Returns the Pareto front of the points, by ascending x: no other point is both further left and lower. */
	report.computeFront = function (points) {
		let least = Infinity;
		return d3.sort(points, (point) => point.x, (point) => point.y).filter((point) => {
			const isBetter = point.y < least;
			least = Math.min(least, point.y);
			return isBetter;
		});
	};

	/* Draws a plot with logarithmic axes into the element host, with its width, and replaces an earlier plot there. plot:
	   { points, front (points of the Pareto front), x_label, y_label, x_domain, y_domain, x_ticks ([x, name] of each; absent:
	   chosen automatically), height_px, labels: "best" | "end" | null (where techniques are labelled), describe(point): lines of
	   the tooltip, onPick(item): called on a click, name }. A point: { x, y, technique, is_hollow, item }. Returns
	   { mark(item) }, which highlights the point of an item. */
	report.drawPlot = function (host, plot) {
		const width_px = Math.max(240, Math.floor(host.clientWidth));
		const isLabelled = plot.labels && width_px >= LABELLED_WIDTH_PX;
		const groups = d3.groups(plot.points, (point) => point.technique);
		const ofTechnique = (id) => report.getTechnique(id);
		measuring.font = LABEL_FONT;
		const right_px = isLabelled && plot.labels === "end"
			? d3.max(groups, ([id]) => measuring.measureText(ofTechnique(id).name).width) + 16 : MARGIN_PX.right;
		const x_ticks = plot.x_ticks ? plot.x_ticks.map(([x]) => x) : chooseTicks(plot.x_domain, width_px - MARGIN_PX.left - right_px, 38);
		const x_names = new Map(plot.x_ticks || []);
		const y_ticks = chooseTicks(plot.y_domain, plot.height_px - MARGIN_PX.top - MARGIN_PX.bottom, 22);
		// Tick labels are set explicitly, because d3 omits some on a logarithmic axis.
		const axes = [Plot.gridX(x_ticks), Plot.gridY(y_ticks), Plot.axisX(x_ticks, { text: (x) => x_names.get(x) || report.showTick(x), tickSize: 0, label: plot.x_label }),
			Plot.axisY(y_ticks, { text: report.showTick, tickSize: 0, label: plot.y_label })];
		const marks = groups.map(([id, points]) => Plot.line(d3.sort(points, (point) => point.x), {
			x: "x", y: "y", stroke: ofTechnique(id).color, strokeWidth: 1.5, strokeOpacity: 0.65, className: `t${ofTechnique(id).index}`,
		}));
		groups.forEach(([id, points]) => marks.push(Plot.dot(points, {
			x: "x", y: "y", r: 4.6, symbol: ofTechnique(id).symbol, className: `t${ofTechnique(id).index}`,
			fill: (point) => (point.is_hollow ? "var(--card)" : ofTechnique(id).color),
			stroke: (point) => (point.is_hollow ? ofTechnique(id).color : "var(--card)"), strokeWidth: 1.2,
		})));
		if (plot.front && plot.front.length > 0) {
			const first = { x: plot.front[0].x, y: plot.y_domain[1] };
			const last = { x: plot.x_domain[1], y: plot.front.at(-1).y };
			// The label is placed below the right end of the front, where there are no dots.
			marks.unshift(Plot.line([first, ...plot.front, last], {
				x: "x", y: "y", curve: "step-after", stroke: "var(--front)", strokeWidth: 5, strokeOpacity: 0.5, strokeLinejoin: "round",
			}), Plot.text([last], { x: "x", y: "y", text: ["Pareto front"], textAnchor: "end", dy: 11, fill: "var(--soft)", fontSize: 11 }));
		}
		const svg = Plot.plot({
			className: "plot", width: width_px, height: plot.height_px, ariaLabel: plot.name, marks: [...axes, ...marks],
			marginLeft: MARGIN_PX.left, marginRight: right_px, marginTop: MARGIN_PX.top, marginBottom: MARGIN_PX.bottom,
			x: { type: "log", domain: plot.x_domain }, y: { type: "log", domain: plot.y_domain },
			symbol: { type: "identity" },
			style: { fontSize: "11px", background: "none", overflow: "visible" },
		});
		svg.setAttribute("role", "img");
		const [x, y] = [svg.scale("x"), svg.scale("y")];
		const dots = plot.points.map((point) => ({ point, x_px: x.apply(point.x), y_px: y.apply(point.y) }));
		if (isLabelled) {
			const placed = plot.labels === "end" ? placeAtEnd(groups, dots) : placeNearBest(groups, dots, width_px, plot.height_px);
			addLabels(svg, placed);
		}
		host.replaceChildren(svg);
		return { mark: addPointer(svg, dots, plot) };
	};

	function addLabels(svg, labels) {
		d3.select(svg).append("g").attr("class", "labels").selectAll("text").data(labels).join("text")
			.attr("class", (label) => `t${label.technique.index}`).attr("x", (label) => label.x_px).attr("y", (label) => label.y_px)
			.attr("dy", "0.32em").attr("text-anchor", "start").text((label) => label.technique.name);
	}

	/* Places labels right of the last point of each technique, moved apart if they would overlap. */
	function placeAtEnd(groups, dots) {
		const labels = groups.map(([id]) => {
			const last = d3.greatest(dots.filter((dot) => dot.point.technique === id), (dot) => dot.x_px);
			return { technique: report.getTechnique(id), x_px: last.x_px + 11, y_px: last.y_px };
		});
		labels.sort((a, b) => a.y_px - b.y_px);
		for (let index = labels.length - 2; index >= 0; index--) {
			labels[index].y_px = Math.min(labels[index].y_px, labels[index + 1].y_px - LABEL_HEIGHT_PX);
		}
		return labels;
	}

	/* Places the label of each technique next to one of its dots, preferably that of lowest error, where it overlaps least. */
	function placeNearBest(groups, dots, width_px, height_px) {
		const taken = dots.map((dot) => ({ left: dot.x_px - 6, right: dot.x_px + 6, top: dot.y_px - 6, bottom: dot.y_px + 6 }));
		const getOverlap = (a, b) => Math.max(0, Math.min(a.right, b.right) - Math.max(a.left, b.left)) *
			Math.max(0, Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top));
		return groups.map(([id]) => {
			const technique = report.getTechnique(id);
			const text_px = measuring.measureText(technique.name).width + 4;
			const own = d3.sort(dots.filter((dot) => dot.point.technique === id), (dot) => dot.point.y);
			const candidates = own.flatMap((dot, rank) => [[10, 0], [-10 - text_px, 0], [-text_px / 2, -15], [-text_px / 2, 15],
				[8, -13], [8, 13], [-8 - text_px, -13], [-8 - text_px, 13]].map(([x_px, y_px], side) => {
				const box = { left: dot.x_px + x_px, right: dot.x_px + x_px + text_px,
					top: dot.y_px + y_px - LABEL_HEIGHT_PX / 2, bottom: dot.y_px + y_px + LABEL_HEIGHT_PX / 2 };
				const isOutside = box.left < MARGIN_PX.left || box.right > width_px || box.top < MARGIN_PX.top ||
					box.bottom > height_px - MARGIN_PX.bottom;
				// Overlaps, in square pixels, and leaving the plot count most. Ties go to the first sides and dots of low error.
				return { box, cost: d3.sum(taken, (other) => getOverlap(box, other)) + (isOutside ? 1e6 : 0) + side + 3 * rank };
			}));
			const { box } = d3.least(candidates, (candidate) => candidate.cost);
			taken.push(box);
			return { technique, x_px: box.left, y_px: (box.top + box.bottom) / 2 };
		});
	}

	/* Adds the tooltip and the rings around the hovered and the chosen dot. Returns a function that chooses an item. */
	function addPointer(svg, dots, plot) {
		const chosen = d3.select(svg).append("circle").attr("class", "chosen").attr("r", 10).attr("visibility", "hidden");
		const ring = d3.select(svg).append("circle").attr("class", "ring").attr("r", 8).attr("visibility", "hidden");
		const move = (circle, dot) => circle.attr("visibility", dot ? "visible" : "hidden")
			.attr("cx", dot ? dot.x_px : 0).attr("cy", dot ? dot.y_px : 0);

		function find(event) {
			const box = svg.getBoundingClientRect();
			const scale = svg.viewBox.baseVal.width / box.width;
			const [x_px, y_px] = [(event.clientX - box.left) * scale, (event.clientY - box.top) * scale];
			const seen = dots.filter((dot) => !hidden.has(dot.point.technique));
			const nearest = d3.least(seen, (dot) => Math.hypot(dot.x_px - x_px, dot.y_px - y_px));
			return nearest && Math.hypot(nearest.x_px - x_px, nearest.y_px - y_px) < PICK_DISTANCE_PX ? nearest : null;
		}

		function point(event) {
			const dot = find(event);
			move(ring, dot);
			svg.style.cursor = dot && plot.onPick ? "pointer" : "";
			showTip(dot && plot.describe(dot.point), dot && dot.point, event);
		}

		svg.addEventListener("pointermove", point);
		svg.addEventListener("pointerdown", point);
		svg.addEventListener("pointerleave", () => {
			move(ring, null);
			showTip(null);
		});
		svg.addEventListener("click", (event) => {
			const dot = find(event);
			if (dot && plot.onPick) {
				plot.onPick(dot.point.item);
			}
		});
		return (item) => move(chosen, dots.find((dot) => dot.point.item === item));
	}

	function showTip(lines, point, event) {
		tip.hidden = !lines;
		if (!lines) {
			return;
		}
		const technique = report.getTechnique(point.technique);
		tip.replaceChildren(make("b", { class: "name" }, report.makeSwatch(technique), technique.name),
			...lines.map((line) => make("span", {}, line)));
		const box = tip.getBoundingClientRect();
		const left_px = Math.min(event.clientX + 14, window.innerWidth - box.width - 8);
		const isBelow = event.clientY - box.height - 14 < 8;
		tip.style.left = `${Math.max(8, left_px)}px`;
		tip.style.top = `${isBelow ? event.clientY + 18 : event.clientY - box.height - 14}px`;
	}
	window.addEventListener("scroll", () => showTip(null), { passive: true });

	/* Creates the legend: one button per technique, pressed while the technique is shown. Techniques are hidden by a CSS rule, so
	   that no plot has to be redrawn. */
	report.fillLegend = function (host) {
		const rules = make("style");
		document.head.append(rules);
		const buttons = [...report.techniques.values()].map((technique) => make("button", {
			type: "button", "aria-pressed": "true", title: "Show or hide in all plots", onclick: () => toggle(technique),
		}, report.makeSwatch(technique), technique.name));
		const all = make("button", { type: "button", class: "all", hidden: true, onclick: () => toggle(null) }, "show all");
		host.append(make("div", {}, buttons, all));

		function toggle(technique) {
			if (!technique) {
				hidden.clear();
			} else if (!hidden.delete(technique.id)) {
				hidden.add(technique.id);
			}
			const techniques = [...report.techniques.values()];
			techniques.forEach((item, index) => buttons[index].setAttribute("aria-pressed", String(!hidden.has(item.id))));
			rules.textContent = techniques.filter((item) => hidden.has(item.id))
				.map((item) => `.plot .t${item.index} { display: none; }`).join("\n");
			all.hidden = hidden.size === 0;
		}
	};
})();

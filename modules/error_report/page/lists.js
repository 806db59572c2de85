/* Tables that are sorted by a click on a heading, and the sections that consist of tables: ranking, comparison, budget. */
(function () {
	"use strict";

	const report = window.GnomonReport;
	const make = report.make;
	const BUDGET_STEP_COUNT = 1000;

	/* Creates a table. columns: { title, help, value(row) for sorting, show(row): text or element, isText, best: "least" |
	   "nearest zero" (highlights the best value), hasBar }. The rows must be sorted by the column sortedIndex, ascending; -1:
	   not sorted. Rows with isPartial(row) are pale and never the best, since their means are over fewer configurations. */
	report.makeTable = function (caption, columns, rows, sortedIndex, isPartial = () => false) {
		const compared = rows.filter((row) => !isPartial(row));
		const body = make("tbody");
		const lines = rows.map((row) => ({ row, element: makeLine(columns, rows, compared, row) }));
		body.append(...lines.map((line) => line.element));
		const headings = columns.map((column, index) => make("th", {
			scope: "col", class: column.isText ? "text" : null, title: column.help,
			"aria-sort": index === sortedIndex ? "ascending" : null,
		}, make("button", { type: "button", onclick: () => sort(index) }, column.title)));

		function sort(index) {
			const isRising = headings[index].getAttribute("aria-sort") !== "ascending";
			headings.forEach((heading) => heading.removeAttribute("aria-sort"));
			headings[index].setAttribute("aria-sort", isRising ? "ascending" : "descending");
			lines.sort((a, b) => compare(columns[index].value(a.row), columns[index].value(b.row), isRising));
			body.append(...lines.map((line) => line.element));
		}

		const table = make("table", {}, make("caption", {}, make("span", {}, caption)), make("thead", {}, make("tr", {}, headings)), body);
		// A box that scrolls must be reachable by keyboard.
		return make("div", { class: "table", tabindex: "0", role: "region", "aria-label": caption }, table);
	};

	/* Compares two values for sorting. Absent values come last in both directions. */
	function compare(a, b, isRising) {
		const isAbsent = (value) => value === undefined || value === null || Number.isNaN(value);
		if (isAbsent(a) || isAbsent(b)) {
			return Number(isAbsent(a)) - Number(isAbsent(b));
		}
		return (isRising ? 1 : -1) * d3.ascending(a, b);
	}

	function makeLine(columns, rows, compared, row) {
		const isCompared = compared.includes(row);
		return make("tr", { class: isCompared ? null : "partial" }, columns.map((column) => {
			const value = column.value(row);
			const measure = column.best === "nearest zero" ? Math.abs : (number) => number;
			const isBest = column.best && isCompared && report.isNumber(value) &&
				measure(value) === d3.min(compared, (other) => measure(column.value(other)));
			const fraction = column.hasBar && report.isNumber(value) ? value / d3.max(rows, column.value) : 0;
			return make("td", {
				class: [column.isText ? "text" : "", isBest ? "best" : "", fraction > 0 ? "bar" : ""].join(" ").trim() || null,
				"--fraction": fraction > 0 ? `${(100 * fraction).toFixed(1)}%` : null,
			}, column.show(row));
		}));
	}

	function makeNumber(title, help, key, show, more) {
		return { title, help, value: (row) => row[key], show: (row) => show(row[key]), ...more };
	}

	const NAME_COLUMNS = [
		{ title: "technique", isText: true, value: (row) => report.getTechnique(row.technique).name,
			show: (row) => report.makeName(row) },
		{ title: "setting", isText: true, value: (row) => report.getSetting(row), show: (row) => report.getSetting(row) },
	];
	const NUMBER_COLUMNS = [
		makeNumber("penumbra MAE", "Mean absolute error over penumbra pixels", "penumbra_mae", report.showError,
			{ best: "least", hasBar: true }),
		makeNumber("RMSE", "Root of the mean squared error over penumbra pixels", "penumbra_rmse", report.showError,
			{ best: "least" }),
		makeNumber("p99", "99 of 100 penumbra pixels have a smaller absolute error", "penumbra_p99", report.showError,
			{ best: "least" }),
		makeNumber("bias", "Mean signed error: − too dark, + too light", "penumbra_bias", report.showBias,
			{ best: "nearest zero" }),
		makeNumber("wrong", "Penumbra pixels whose absolute error exceeds 0.2", "penumbra_wrong", report.showPercent,
			{ best: "least" }),
		makeNumber("wrong, receivers", "Receiver pixels whose absolute error exceeds 0.2: shows what is wrong outside the penumbra too",
			"receiver_wrong", report.showPercent, { best: "least" }),
		makeNumber("umbra over", "Penumbra pixels that are shown as umbra", "umbra_over", report.showPercent,
			{ best: "least" }),
		makeNumber("MAE, whole light", "Penumbra MAE over receivers that see the whole light", "whole_light_penumbra_mae",
			report.showError, { best: "least" }),
		makeNumber("ms", "Median cost_ms", "cost_ms", report.showMs, { best: "least", hasBar: true }),
		makeNumber("× baseline", "Median ratio to the baseline technique in the same configuration", "time_ratio",
			report.showRatio, { best: "least" }),
	];

	report.getMaxConfigurationCount = (rows) => d3.max(rows, (row) => row.configuration_count) || 0;

	report.makeRankingTable = function (caption, rows) {
		const maxCount = report.getMaxConfigurationCount(rows);
		const isPartial = (row) => row.configuration_count < maxCount;
		const count = { title: "measured in", help: "Number of configurations", value: (row) => row.configuration_count,
			show: (row) => make("span", isPartial(row) ? { class: "mark", title: "Fewer configurations than other rows" } : {},
				`${row.configuration_count} of ${maxCount}`) };
		return report.makeTable(caption, [...NAME_COLUMNS, ...NUMBER_COLUMNS, count], rows, NAME_COLUMNS.length, isPartial);
	};

	/* Creates the table of changes since another report; null if there was no report to compare with. */
	report.makeAgainst = function (against) {
		if (!against?.rows) {
			return null;
		}
		const counts = make("p", { class: "soft" }, `${against.compared_count} cells that both measured, ${against.only_old_count} only in the ` +
			`other, ${against.only_new_count} only in this one${against.has_same_machine ? "" : "; on another machine"}.`);
		if (against.rows.length === 0) {
			return make("div", {}, make("p", {}, "Nothing changed by more than the noise."), counts);
		}
		const rows = [...against.rows].sort((a, b) => Number(b.verdict === "worse") - Number(a.verdict === "worse"));
		const showValue = (row, value) => ({ "time ratio": report.showRatio, time: (ms) => `${report.showMs(ms)} ms`,
			status: (isMeasured) => (isMeasured ? "measured" : "failed") }[row.what] || report.showError)(value);
		const getChange = (row) => (row.old > 0 && row.what !== "status" ? row.new / row.old - 1 : null);
		const showChange = (row) => (getChange(row) === null ? row.message || "–"
			: `${getChange(row) < 0 ? "−" : "+"}${(100 * Math.abs(getChange(row))).toFixed(1)} %`);
		return make("div", {}, report.makeTable("Changes since the other report", [
			{ title: "verdict", isText: true, value: (row) => row.verdict,
				show: (row) => make("span", { class: `verdict ${row.verdict === "worse" ? "worse" : "better"}` }, row.verdict) },
			{ title: "configuration", isText: true, value: (row) => row.configuration, show: (row) => row.configuration },
			...NAME_COLUMNS,
			{ title: "what", isText: true, value: (row) => row.what, show: (row) => row.what },
			{ title: "old", value: (row) => row.old, show: (row) => showValue(row, row.old) },
			{ title: "new", value: (row) => row.new, show: (row) => showValue(row, row.new) },
			{ title: "change", value: getChange, show: showChange },
		], rows, -1), counts);
	};

	/* Creates the section in which the reader chooses a time budget: the best setting within it for each configuration. */
	report.makeBudget = function (data) {
		const costs = report.matrix.flatMap((item) => item.cells.map(report.getCostMs)).filter((cost_ms) => cost_ms > 0);
		const section = report.makeSection("budget", "Best within a time budget");
		if (costs.length === 0) {
			section.append(make("p", { class: "soft" }, "Nothing is measured yet."));
			return section;
		}
		const scale = d3.scaleLog([d3.min(costs), d3.max(costs)], [0, BUDGET_STEP_COUNT]).clamp(true);
		const start_ms = data.budget?.budget_ms || Number(d3.median(costs).toPrecision(2));
		const slider = make("input", { type: "range", min: 0, max: BUDGET_STEP_COUNT, "aria-label": "Budget in milliseconds, logarithmic",
			oninput: () => show(Number(scale.invert(Number(slider.value)).toPrecision(3)), slider) });
		const number = make("input", { type: "number", min: 0, step: "any", oninput: () => show(Number(number.value), number) });
		const summary = make("div", { class: "summary", "aria-live": "polite" });
		const table = make("div", { class: "table", tabindex: "0", role: "region", "aria-label": "Choices within the budget" });
		section.append(make("p", { class: "soft" }, "For each configuration: the setting of least penumbra MAE whose cost is within the budget."),
			make("div", { class: "budget" }, make("label", { class: "field" }, make("span", {}, "budget, ms"), number), slider), summary, table);
		const lines = d3.groups(report.matrix, (item) => item.scene, (item) => item.light);
		const columnCount = d3.max(lines.flatMap(([, lights]) => lights.map(([, items]) => items.length)));

		function show(budget_ms, source) {
			// The scale is logarithmic, so its argument must be above 0.
			slider.value = source === slider ? slider.value : scale(Math.max(budget_ms, costs[0] / 1e6));
			number.value = source === number ? number.value : budget_ms;
			const choose = (item) => (item.pareto || []).map((index) => data.cells[index]).findLast((cell) => report.getCostMs(cell) <= budget_ms);
			const counts = d3.rollups(report.matrix, (items) => items.length, (item) => choose(item)?.technique || getNoChoice(item));
			summary.replaceChildren(...d3.sort(counts, ([, count]) => -count).map(([id, count]) => make("span", {},
				report.techniques.has(id) ? report.makeName({ technique: id }) : id, make("b", {}, ` ${count}`))));
			const rows = lines.flatMap(([scene, lights]) => lights.map(([light, items]) => make("tr", {},
				make("th", { scope: "row" }, scene, make("small", {}, light)), items.map((item) => makeChoiceCell(item, choose(item))),
				d3.range(columnCount - items.length).map(() => make("td")))));
			table.replaceChildren(make("table", { class: "choices" },
				make("caption", {}, make("span", {}, `Within ${report.showMs(budget_ms)} ms, smaller lights first`)), make("tbody", {}, rows)));
		}
		show(start_ms, null);
		return section;
	};

	function getNoChoice(configuration) {
		const isMeasured = (configuration.pareto || []).length > 0;
		return isMeasured ? "nothing that fast" : configuration.status === "failed" ? "failed" : "not measured";
	}

	function makeChoiceCell(configuration, cell) {
		const size = make("small", {}, report.getSizeText(configuration));
		if (!cell) {
			return make("td", { class: "text none" }, size, getNoChoice(configuration));
		}
		return make("td", { class: "text" }, size, report.makeName(cell), " ", make("small", { class: "inline" }, report.getSetting(cell)),
			make("small", {}, `${report.showError(report.getMae(cell))} at ${report.showMs(report.getCostMs(cell))} ms`));
	}

	/* Creates the warning in the header: counts of failed and missing cells, references and scene images, with the messages of
	   failed cells and references when unfolded. */
	report.makeWarning = function (data) {
		const failed = data.failed_count || 0;
		const missing = data.missing_count || 0;
		if (failed + missing === 0) {
			return null;
		}
		const items = [];
		for (const configuration of data.configurations) {
			if (configuration.status === "failed") {
				items.push([`Reference of ${configuration.id}`, configuration.message]);
			}
		}
		for (const cell of data.cells.filter((item) => item.status === "failed")) {
			const name = `${report.getTechnique(cell.technique).name}, ${report.getSetting(cell)}`;
			items.push([`${data.configurations[cell.configuration].id}: ${name}`, cell.message]);
		}
		const texts = [failed > 0 ? `${failed} failed` : null, missing > 0 ? `${missing} not measured` : null];
		const line = `Not complete: ${texts.filter((text) => text).join(", ")}. `;
		const note = "Means are over what was measured.";
		if (items.length === 0) {
			return make("p", { class: "warning" }, line, note);
		}
		return make("details", { class: "warning" }, make("summary", {}, line, note),
			make("ul", {}, items.map(([name, message]) => make("li", {}, make("b", {}, name), " ", message || "no message"))));
	};
})();

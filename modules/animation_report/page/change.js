/* The section "Animation": error, and error of change between two frames, at several times of each scene's animation. */
(function () {
	"use strict";

	const report = window.GnomonReport;
	const make = report.make;
	const PLOT_HEIGHT_PX = 300;

	/* key: the value of a point to plot, "temporal_rmse" or "mae". Times are evenly spaced: the plot's x axis is logarithmic, so
	   x is 2 to the power of the index. */
	function drawCurves(host, plot, key, y_label) {
		const times = [...new Set(plot.series.flatMap((series) => series.points.map((point) => point.time_s)))].sort((a, b) => a - b);
		const all = plot.series.flatMap((series) => series.points.map((point) => ({ ...point, technique: series.technique })));
		const floor = report.getErrorFloor(all.map((point) => point[key]));
		const points = all.map((point) => ({ x: 2 ** times.indexOf(point.time_s), y: Math.max(floor, point[key]), technique: point.technique,
			is_hollow: point[key] < floor, item: point }));
		report.drawPlot(host, { points, x_label: "time, s", y_label, height_px: PLOT_HEIGHT_PX, labels: "end",
			x_ticks: times.map((time, index) => [2 ** index, report.showPlain(time)]), x_domain: [2 ** -0.4, 2 ** (times.length - 0.6)],
			y_domain: report.getDomain(points.map((point) => point.y)), name: `${y_label}, ${plot.scene}, ${plot.light}`,
			describe: (point) => [`${report.getTechnique(point.technique).name}, ${report.showPlain(point.item.time_s)} s`,
				`error of change ${report.showError(point.item.temporal_rmse)}`, `MAE ${report.showError(point.item.mae)}`] });
	}

	function makeFigure(plot, key, title, y_label, drawOnEverySize) {
		const host = make("div", { class: "plot-host", "--height": `${PLOT_HEIGHT_PX}px` });
		drawOnEverySize(host, () => drawCurves(host, plot, key, y_label));
		return make("figure", {}, make("h3", {}, `${title}: ${plot.scene}, ${plot.light}`), host);
	}

	/* plots: report.json's "animation". */
	report.parts.set("animation", (plots, drawOnEverySize) => {
		const section = report.makeSection("change", "Animation");
		if (plots.length === 0) {
			return report.add(section, make("p", { class: "soft" }, "Nothing measured: no scene has an animation, or --change is none."));
		}
		section.append(make("p", { class: "soft" }, "The first animation of each scene. Error of change: over penumbra pixels, the root mean square of " +
			"how the mask's change in a thirtieth of a second differs from the reference's; flicker and lag that single frames do not show."),
		make("div", { class: "grid two" }, plots.flatMap((plot) => [
			makeFigure(plot, "temporal_rmse", "Error of change", "error of change", drawOnEverySize),
			makeFigure(plot, "mae", "Error", "MAE", drawOnEverySize)])));
		return section;
	});
})();

// What each choice makes of what the study observes, against what step and mesh leave open: the rows of answers.csv as bars.
{
  const threshold = 1, mostRows = 18;   // per cent: below it a difference is said not to matter
  const verdicts = { decides: "#D55E00", depends: "#E69F00", "not resolved": "#7A7A7A", "does not matter": "#009E73", "not told": "#7A7A7A" }, open = "left open by step and mesh", openColour = "#D9D9D9";

  ricochet.answeredBy("choice-effects");
  ricochet.figure("choice-effects", (data) => {
    const { spaced, percent } = ricochet.format, all = data.rows("answers").filter((row) => row.measure && row.effect !== null && verdicts[row.verdict]);
    if (!all.length) return [];
    const measures = ricochet.distinct(all.map((row) => row.measure)), ordered = measures.flatMap((measure) => all.filter((row) => row.measure === measure)), shown = ordered.slice(0, mostRows);
    const left = (row) => Math.max(row.step_open || 0, row.mesh_open || 0), choice = (row) => ({ mass: "mass matrix", contact: "contact law", time: "time scheme" }[row.choice] || ricochet.shorten(row.choice));
    // Where a choice does not matter in some combinations and is not resolved in others, each has a row of its own.
    const parts = (row) => all.filter((other) => other.measure === row.measure && other.choice === row.choice);
    const part = (row) => parts(row).length > 1 ? " (" + row.combinations + " of " + parts(row).reduce((sum, other) => sum + other.combinations, 0) + ")" : "";
    const rows = shown.map((row) => ({
      name: spaced(row.measure) + ": " + choice(row) + part(row), verdict: row.verdict, effect: 100 * row.effect, largest: 100 * row.largest, left: left(row) > 0 ? 100 * left(row) : null,
      text: row.verdict + ": " + percent(row.effect) + (row.combinations > 1 ? " (median of " + row.combinations + " combinations, up to " + percent(row.largest) + ")" : "") + (row.scale ? " " + row.scale : "") +
        (left(row) > 0 ? "; step and mesh leave " + percent(left(row)) + " open" : ""),
    }));
    const range = new ricochet.Interval().include(threshold, ...rows.flatMap((row) => [row.effect, row.largest, row.left]).filter((value) => value > 0));
    const x = ["difference", "% of the scale"], along = ricochet.logarithmicSweep(range) ? ricochet.logAxis(x, range, false) : ricochet.valueAxis(x, ricochet.roundOutwards(new ricochet.Interval(0, range.high), 1e-9), false);
    along.startValue = along.min;
    const out = ricochet.namedRows(rows.map((row) => row.name), x, along), legend = [];
    const drawn = rows.map((row) => ({ ...row, effect: row.effect > along.min ? row.effect : along.min }));
    // A band is a wide line: bars of two widths do not share a middle.
    const bands = ricochet.ends(drawn.filter((row) => row.left > along.min).map((row) => ({ ...row, from: along.min })), "from", "left");
    if (bands.length) ricochet.draw(out, bands, { x: "end", y: "name" }, { ...ricochet.line(open, openColour, 18), lineStyle: { width: 18, color: openColour, cap: "butt" }, z: 1 });
    if (bands.length) legend.push(ricochet.swatch(open, openColour));
    for (const [verdict, colour] of Object.entries(verdicts)) {
      if (!rows.some((row) => row.verdict === verdict)) continue;
      ricochet.draw(out, drawn, { x: "effect", y: "name" }, { type: "bar", name: verdict, color: colour, barWidth: 9, barGap: "-100%", z: 3, itemStyle: { color: colour } }, { verdict });
      const more = drawn.filter((row) => row.verdict === verdict && row.largest > row.effect);
      if (more.length) ricochet.draw(out, ricochet.ends(more, "effect", "largest"), { x: "end", y: "name" }, { ...ricochet.line(verdict, colour, 1.4), symbol: "rect", symbolSize: [1.5, 9], z: 4 });
      legend.push(ricochet.swatch(verdict, colour));
    }
    const line = { silent: true, symbol: "none", animation: false, label: { show: true, formatter: threshold + " %", position: "start", distance: 3, fontSize: 10, color: "#777777" }, lineStyle: { color: "#777777", type: "dashed", width: 1 } };
    out.option.series.push({ type: "line", name: "threshold", data: [], silent: true, markLine: { ...line, data: [{ xAxis: threshold }] } });
    if (ordered.length > shown.length) out.notes.push(ordered.length - shown.length + " more rows are in answers.csv.");
    return [{
      id: "choice-effects", title: "What each choice changes", views: ["difference"], legend, charts: [{ title: "all cases", height: out.height, views: [out], notes: [] }],
      caption: "Bar: the difference that a choice makes, all else the same and as fine as there is (median over the combinations; the line ends at the largest). Grey: how far the two finest steps and meshes are apart. A bar inside the grey is not told from it; left of 1 % it does not matter.",
    }];
  });
}

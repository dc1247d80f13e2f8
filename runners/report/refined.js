// The measure that the answer rests on, as each method is refined: limits.csv and refinements.csv as lines, the limit
// of each at the right.
{
  const mostNamed = 12, tiers = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00"], none = "#7A7A7A";
  const colourOf = (row) => (row.tier ? tiers[(row.tier - 1) % tiers.length] : none);
  const height = 400;  // pixels
  const told = ["keeps", "differ", "gains", "none", "open", "value"];

  ricochet.figure("refined", (data) => {
    const [first] = data.rows("answers"),
          all = data.rows("limits").filter((row) => first && row.measure === first.measure);
    if (!first || !told.includes(first.form) || !all.length) return [];
    const along = Math.max(...all.map((row) => row.steps)) > 1 ? "step" : "mesh",
          rowsOf = data.rowsBy("refinements", ["measure", "method", "refined"]);
    const points = (row) => [...rowsOf(row.measure, row.case, along)].sort((a, b) => a.size - b.size);
    if (!all.some((row) => points(row).length > 1)) return [];
    // The best first, as the table has them; those beyond a dozen are lines without a name.
    const methods = [...all].sort((a, b) => (a.tier || Infinity) - (b.tier || Infinity) || b.value - a.value),
          named = methods.slice(0, mostNamed);
    const words = data.measureWords(first.measure), quantity = [words, all[0].unit],
          sizes = new ricochet.Interval().include(...methods.flatMap((row) => points(row).map((one) => one.size)));
    const heights = new ricochet.Interval().include(
        ...methods.flatMap((row) => [row.value, ...points(row).map((one) => one.value)]),
        ...methods.map((row) => row.truth).filter((value) => value !== null));
    // The axis holds the intervals of what has a name.
    heights.include(...named.flatMap((row) => [row.low, row.high])
                        .filter((value) => value !== null && (value > 0 || heights.low <= 0)));
    const logarithmic = ricochet.logarithmicSweep(heights),
          y = logarithmic ? ricochet.logAxis(quantity, heights) :
                            ricochet.heightAxis(quantity, ricochet.roundOutwards(heights, 1e-9));
    // Refinement goes to the right, the limit behind it.
    const unit = along === "step" ? data.view.unit("step") || "s" : "elements",
          x = ricochet.logAxis([along === "step" ? "step h" : "mesh", unit], sizes), step = along === "step";
    const beyond = 0.3, spread = Math.max(sizes.high / sizes.low, 2),
          end = step ? sizes.low / Math.pow(spread, 0.5 * beyond) : sizes.high * Math.pow(spread, 0.5 * beyond);
    Object.assign(
        x, step ? {inverse: true, min: end / 1.02, max: sizes.high * 1.05} : {min: sizes.low / 1.05, max: end * 1.02});
    // A decade has no label of its own in so short a range.
    const ticks = ricochet.distinct(methods.flatMap((row) => points(row).map((one) => one.size)));
    if (spread < 30 && ticks.length <= 8) {
      x.ticks = ticks;
      x.format = (value) => ricochet.format.shown(value, 3);
    }
    const out = ricochet.view([step ? "step h" : "mesh", unit], quantity, x, y), narrow = window.innerWidth < 600;
    out.frames[0].right = narrow ? 96 : 170;
    const clip = (value) => Math.min(Math.max(value, y.min), y.max);
    const styles = new Map();
    methods.forEach((row) => {
      const colour = colourOf(row), style = styles.get(colour) || 0, isNamed = named.includes(row), curve = {
        name: row.method || "the one method",
        colour: isNamed ? colour : ricochet.lighten(none, 0.5),
        style: isNamed ? style : 0
      };
      styles.set(colour, style + 1);
      const rows = points(row)
                       .map((one) => ({case: row.case, at: one.size, height: one.value}))
                       .filter((one) => !logarithmic || one.height > 0);
      ricochet.draw(
          out, rows, {x: "at", y: "height"},
          isNamed ? ricochet.curve(curve, 7, 1.6) : {...ricochet.line(curve.name, curve.colour, 1), z: 0});
      if (!isNamed) return;
      const low = row.low === null ? row.value : row.low, high = row.high === null ? row.value : row.high,
            text = row.status + ": " + ricochet.format.shown(low, 4) + " to " + ricochet.format.shown(high, 4) +
          ricochet.format.unit(quantity);
      const bar = [low, high].map((height) => ({case: row.case, at: end, height: clip(height), text}));
      ricochet.draw(
          out, bar, {x: "at", y: "height"}, {...ricochet.line(curve.name, colour, 3), symbol: "bar", size: 10, z: 4});
      ricochet.draw(
          out, [{case: row.case, at: end, height: clip(row.value), text}], {x: "at", y: "height"},
          {...ricochet.dot(curve.name, colour, "circle", 5, 5), side: ricochet.shorten(curve.name)});
    });
    const truth = all[0].truth;
    if (truth !== null && truth !== undefined)
      out.marks.push(ricochet.rule("exact", {y: truth}, "exact", {dash: [4, 3]}));
    if (methods.length > named.length)
      out.notes.push(methods.length - named.length + " more methods are grey; all are in limits.csv.");
    ricochet.answeredFirst("refined");
    return [{
      id: "refined",
      title: words[0].toUpperCase() + words.slice(1) + " as it is refined",
      views: ["value"],
      legend: [],
      charts: [{title: "all methods", height, views: [out], notes: []}],
      caption: "One colour per set of methods that are not told apart, the best first. Bars at the right: where each " +
          "limit may be. Refinement goes to the right.",
    }];
  });
}

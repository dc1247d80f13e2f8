// How far each choice moves what the study observes, against what step and mesh leave of that: the rows of
// differences.csv as bars.
{
  const threshold = 1, mostRows = 18;  // per cent: below it a difference is said not to matter
  const verdicts = {matters: "#D55E00", "matters in part": "#E69F00", open: "#7A7A7A", "does not matter": "#009E73"},
        left = "left by step and mesh", leftColour = "#D9D9D9";
  const median = (values) => {
    const sorted = [...values].sort((a, b) => a - b), half = Math.floor(sorted.length / 2);
    return sorted.length % 2 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
  };
  // As the answer has it: in more than half of the combinations, in nine of ten not, in some, or open.
  const verdictOf = (rows) => {
    const count = (verdict) => rows.filter((row) => row.verdict === verdict).length, yes = count("matters");
    return 2 * yes > rows.length                         ? "matters" :
        10 * count("does not matter") >= 9 * rows.length ? "does not matter" :
        yes                                              ? "matters in part" :
                                                           "open";
  };

  ricochet.figure("choice-effects", (data) => {
    const {percent} = ricochet.format, all = data.rows("differences");
    if (!all.length) return [];
    const choice = (name) =>
        ({mass: "mass matrix", contact: "contact law", time: "time scheme"}[name] || ricochet.shorten(name));
    const pairs =
        ricochet.distinct(all.map((row) => row.measure))
            .flatMap(
                (measure) => ricochet.distinct(all.filter((row) => row.measure === measure).map((row) => row.choice))
                                 .map((name) => [measure, name]));
    const ordered = pairs.map(([measure, name]) => {
      const rows = all.filter((row) => row.measure === measure && row.choice === name),
            sizes = rows.map((row) => row.difference), open = rows.map((row) => row.u).filter((u) => u !== null),
            verdict = verdictOf(rows);
      const effect = median(sizes), largest = Math.max(...sizes), rest = open.length ? median(open) : null;
      return {
        name: data.measureWords(measure) + ": " + choice(name),
        verdict,
        effect,
        largest,
        left: rest > 0 ? rest : null,
        text: verdict + ": " + percent(effect / 100) +
            (rows.length > 1 ? " (median of " + rows.length + " combinations, up to " + percent(largest / 100) + ")" :
                               "") +
            (rest > 0 ? "; step and mesh leave " + percent(rest / 100) : "")
      };
    });
    const rows = ordered.slice(0, mostRows);
    const range = new ricochet.Interval().include(
        threshold, ...rows.flatMap((row) => [row.effect, row.largest, row.left]).filter((value) => value > 0));
    const x = ["difference", "% of the scale"],
          along = ricochet.logarithmicSweep(range) ?
        ricochet.logAxis(x, range) :
        ricochet.valueAxis(x, ricochet.roundOutwards(new ricochet.Interval(0, range.high), 1e-9));
    const out = ricochet.namedRows(rows.map((row) => row.name), x, along), legend = [];
    const drawn = rows.map((row) => ({...row, effect: row.effect > along.min ? row.effect : along.min}));
    // A band is a wide line: bars of two widths do not share a middle.
    const bands = ricochet.ends(
        drawn.filter((row) => row.left > along.min).map((row) => ({...row, from: along.min})), "from", "left");
    if (bands.length) ricochet.draw(out, bands, {x: "end", y: "name"}, ricochet.line(left, leftColour, 18));
    if (bands.length) legend.push(ricochet.swatch(left, leftColour));
    for (const [verdict, colour] of Object.entries(verdicts)) {
      if (!rows.some((row) => row.verdict === verdict)) continue;
      ricochet.draw(
          out, drawn, {x: "effect", y: "name"}, {mark: "bars", name: verdict, colour, thick: 9, z: 3}, {verdict});
      const more = drawn.filter((row) => row.verdict === verdict && row.largest > row.effect);
      if (more.length)
        ricochet.draw(
            out, ricochet.ends(more, "effect", "largest"), {x: "end", y: "name"},
            {...ricochet.line(verdict, colour, 1.4), symbol: "tick", size: 9, z: 4});
      legend.push(ricochet.swatch(verdict, colour));
    }
    out.marks.push(ricochet.rule("threshold", {x: threshold}, threshold + " %", {dash: [4, 3]}));
    if (ordered.length > rows.length) out.notes.push(ordered.length - rows.length + " more are in differences.csv.");
    return [{
      id: "choice-effects",
      answers: true,
      title: "What each choice changes",
      views: ["difference"],
      legend,
      charts: [{title: "all cases", height: out.height, views: [out], notes: []}],
      caption:
          "Bar: the difference between the levels that are farthest apart, all else the same and as fine as there is " +
          "(median over the combinations; the line ends at the largest). Grey: what step and mesh still move that " +
          "difference by. Left of 1 % a choice does not matter.",
    }];
  });
}

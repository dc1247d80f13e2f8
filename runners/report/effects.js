// Shares of variance per measure: one bar per factor or interaction with its interval.
{
  const mostBars = 12;
  const kinds = [
    ["one choice", "#0072B2"], ["interaction of two", "#E69F00"], ["interaction of three", "#009E73"],
    ["higher interactions", "#CC79A7"], ["repeats", "#999999"]
  ];

  const rank = (factor) => factor === "higher" ? 3 : factor === "repeats" ? 4 : factor.split(" × ").length - 1;
  const kindOf = (factor) => kinds[rank(factor)][0];

  function chart(measure, shares) {
    const {percent, spaced} = ricochet.format, name = spaced(measure.measure), x = ["share of the variance", "%"];
    const out = ricochet.namedRows(
        shares.map((row) => ricochet.shorten(row.factor)), x, ricochet.valueAxis(x, new ricochet.Interval(0, 100)), 17);
    out.y = [measure.log ? "log₁₀ " + name : name, "1"];
    const rows = shares.map((row) => ({
                              factor: ricochet.shorten(row.factor),
                              kind: kindOf(row.factor),
                              share: 100 * row.share,
                              low: 100 * row.low,
                              high: 100 * row.high,
                              text: percent(row.share) + " [" + percent(row.low) + ", " + percent(row.high) + "]",
                            }));
    for (const [kind, colour] of kinds)
      ricochet.draw(
          out, rows, {x: "share", y: "factor"},
          {mark: "bars", name: kind, thick: 0.58, colour: ricochet.lighten(colour, 0.25)}, {kind});
    const ends = ricochet.ends(rows, "low", "high");
    for (const [kind] of kinds)
      ricochet.draw(
          out, ends, {x: "end", y: "factor"}, {...ricochet.line(kind, "#222222", 1.4), symbol: "tick", size: 9, z: 4},
          {kind});
    return out;
  }

  ricochet.figure("effects", (data) => {
    const charts = [];
    for (const measure of data.rows("effects_said")) {
      const shares =
          data.rows("effects").filter((row) => row.measure === measure.measure).sort((a, b) => b.share - a.share);
      if (!shares.length || !(shares[0].share > 0)) continue;
      const view = chart(measure, shares.slice(0, mostBars));
      if (measure.rest > 0)
        view.notes.push(
            "Not drawn: " + measure.rest + " smaller, together " + ricochet.format.percent(measure.rest_share) + ".");
      charts.push({title: ricochet.format.spaced(measure.measure), views: [view], notes: [measure.sentence]});
    }
    if (!charts.length) return [];
    const caption =
              "Shares of the variance of a measure over all combinations of the choices: of one choice alone, and of " +
        "interactions, where what one does depends on the others. " +
        "Lines: 95 % of the shares when levels are given random weights; wide where a share hangs on which levels " +
        "the study holds.",
          used = ricochet.drawnNames(charts);
    const legend = kinds.filter(([kind]) => used.has(kind)).map(([name, colour]) => ({name, colour, symbol: "rect"}));
    return [{
      id: "effects",
      title: "Shares of the choices, measure by measure",
      caption,
      views: ["share of the variance"],
      charts,
      legend
    }];
  });
}

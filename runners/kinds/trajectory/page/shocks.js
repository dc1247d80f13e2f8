// The largest shocks of each method at its finest step and mesh: peak force over time, a chart per stop.
ricochet.figure("shocks", (data) => {
  const {view} = data, found = data.rows("shock_points").filter((row) => data.byId.has(row.case) && row.peak > 0);
  if (!found.length) return [];
  const stops = ricochet.distinct(found.map((row) => row.stop)),
        cases = ricochet.distinct(found.map((row) => data.byId.get(row.case)));
  const x = ["time t", "s"], y = ["peak force", "N"],
        times = new ricochet.Interval().include(0, ...found.map((row) => row.t)),
        peaks = new ricochet.Interval().include(0, ...found.map((row) => row.peak));
  // Methods of one colour are told apart by their marks.
  const symbols = ["circle", "diamond", "triangle", "rect", "arrow"], symbolOf = new Map(), used = {};
  for (const one of cases)
    symbolOf.set(one.id, symbols[(used[view.colour(one)] = (used[view.colour(one)] || 0) + 1) % symbols.length]);
  const legend = [], charts = stops.map((stop) => {
    const out = ricochet.view(
        x, y, ricochet.valueAxis(x, ricochet.roundOutwards(times, 1e-12)),
        ricochet.heightAxis(y, ricochet.roundOutwards(peaks, ricochet.leastSpan(peaks))));
    for (const one of cases) {
      const name = view.label(one, view.varyingWithout(["step", "elements"])) || "all cases", colour = view.colour(one),
            symbol = symbolOf.get(one.id);
      const rows = found.filter((row) => row.stop === stop && row.case === one.id)
                       .map((row) => ({
                              ...row,
                              text: ricochet.format.text(row.duration, 3) + " s, " +
                                  ricochet.format.count(row.rebounds, "rebound", "rebounds")
                            }));
      if (rows.length)
        ricochet.draw(out, rows, {x: "t", y: "peak"}, {...ricochet.dot(name, colour, symbol, 6), opacity: 0.7});
      if (!legend.some((entry) => entry.name === name)) legend.push(ricochet.swatch(name, colour, symbol));
    }
    return {title: "stop " + stop, views: [out], notes: []};
  });
  return [{
    id: "shocks",
    title: "Shocks at the stops",
    views: ["peak force"],
    charts,
    legend,
    caption:
        "A mark per shock: its largest force, when that is. Each method at its finest step and mesh; of many shocks " +
        "the largest. All of them: shocks.csv.",
  }];
});

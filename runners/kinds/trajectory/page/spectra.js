// Power spectral densities: between which all methods are at their finest step and mesh, and what the last refinement
// moves.
ricochet.figure("spectra", (data) => {
  const found = data.rows("spectrum_bands");
  if (!found.length) return [];
  const colour = "#0072B2", pale = "#8CBFE0", units = {displacement: "m²/Hz", force: "N²/Hz"};
  const series = ricochet.distinct(found.map((row) => row.of + "\n" + row.quantity)), charts = series.map((key) => {
    const [of, quantity] = key.split("\n"),
               rows = found.filter((row) => row.of === of && row.quantity === quantity && row.frequency > 0);
    const x = ["frequency f", "Hz"], y = ["power spectral density", units[quantity]],
          top = Math.max(...rows.map((row) => row.high)), floor = 1e-12 * top;  // below it nothing is seen
    const range = new ricochet.Interval().include(
              ...rows.flatMap((row) => [row.least, row.high]).filter((value) => value > floor)),
          along = new ricochet.Interval().include(...rows.map((row) => row.frequency));
    if (range.empty)
      return {
        title: of + ", " + quantity,
        views: [ricochet.view(x, y, ricochet.logAxis(x, along), ricochet.heightAxis(y, new ricochet.Interval(0, 1)))],
        notes: ["Zero at every frequency."]
      };
    const out = ricochet.view(x, y, ricochet.logAxis(x, along), ricochet.logAxis(y, range));
    const shown = rows.map(
        (row) => Object.fromEntries(Object.entries(row).map(
            ([name,
              value]) => [name, typeof value === "number" && name !== "frequency" && value <= floor ? null : value])));
    for (const [column, name, tint, width] of [
             ["low", "widened by the last refinement", pale, 1], ["high", "widened by the last refinement", pale, 1],
             ["least", "all methods", colour, 1.4], ["largest", "all methods", colour, 1.4]])
      ricochet.draw(out, shown, {x: "frequency", y: column}, ricochet.line(name, tint, width));
    return {title: of + ", " + quantity, views: [out], notes: []};
  });
  return [{
    id: "spectra",
    title: "Power spectral densities",
    views: ["density"],
    charts,
    legend: [ricochet.swatch("all methods", colour), ricochet.swatch("widened by the last refinement", pale)],
    caption:
        "One-sided, by Welch's method over the window. Between the dark lines are all methods at their finest step " +
        "and mesh; the pale ones add what the last refinement moves. Forces are impulses over the sampling interval: " +
        "levels near half the rate are low by sinc².",
  }];
});

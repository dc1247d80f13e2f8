// How far a contact point passed its stop, against every axis; said in one line where rounding alone makes it.
{
  const ulps = 16;  // of the largest length of the scene: some operations in a row

  // What rounding makes of a place as far out as the stops or the tip.
  function roundOff(data) {
    const {lower, upper} = (data.study.resolved.scene || {}).stops || {};
    const stops = [lower, upper].map((stop) => Math.abs(Number(stop))).filter(Number.isFinite),
          tips = data.view.all.map((one) => ricochet.measureOf(one, "largest_tip_displacement") || 0);
    return ulps * Number.EPSILON * Math.max(0, ...stops, ...tips);
  }

  ricochet.figure("penetration", (data) => {
    const of = (one) => ricochet.measureOf(one, "deepest_penetration"),
          known = data.view.all.map(of).filter((value) => value !== null), deepest = Math.max(0, ...known);
    const said = {
      id: "penetration",
      title: "Deepest penetration",
      caption:
          "The largest distance by which a contact point passed its stop, over every step. 2⁻⁵² of the stop's own " +
          "position is round-off."
    };
    if (known.length && deepest <= roundOff(data))
      return [{
        ...said,
        caption: "None beyond round-off: no contact point passed its stop by more than " +
            ricochet.format.text(deepest, 2) + " m.",
        views: [],
        charts: [],
        legend: []
      }];
    return ricochet.alongAxes(data, {
      ...said,
      values: [{view: "deepest penetration (m)", quantity: ["deepest penetration", "m"], logarithmic: true, of}]
    });
  });
}

// The shares of the choices in what the study observes, where they tell most of it. A bar per measure has a part per
// choice or interaction, with its interval.
{
  const half = 0.5, least = 0.04, mostParts = 10, others = "all others", grey = "#BDBDBD";

  const interval = ({low, high}) => (100 * low).toFixed(0) + "–" + (100 * high).toFixed(0);

  ricochet.answeredBy("shares");
  ricochet.figure("shares", (data) => {
    const {percent, spaced} = ricochet.format, effects = data.rows("effects"),
                    told = (measure) =>
                        effects.filter((row) => row.measure === measure).reduce((sum, row) => sum + row.share, 0);
    const measures = ricochet.observedMeasures(data).filter((measure) => told(measure) >= half);
    if (!measures.length) return [];
    const own = effects.filter((row) => measures.includes(row.measure)),
          largest = (factor) => Math.max(...own.filter((row) => row.factor === factor).map((row) => row.share));
    const factors = ricochet.distinct(own.map((row) => row.factor))
                        .filter((factor) => largest(factor) >= least)
                        .sort((a, b) => largest(b) - largest(a))
                        .slice(0, mostParts);
    const x = ["share of the variance", "%"],
          out = ricochet.namedRows(measures.map(spaced), x, ricochet.valueAxis(x, new ricochet.Interval(0, 100)), 46);
    const part = (row, factor) => ({
      measure: spaced(row.measure),
      factor: ricochet.shorten(factor),
      share: 100 * row.share,
      label: row.share < 0.07 ? "" : percent(row.share) + "\n" + interval(row),
      text:
          percent(row.share) + " of the variance of " + spaced(row.measure) + ", 95 % interval " + interval(row) + " %",
    });
    const rest = measures.map((measure) => {
      const share = own.filter((row) => row.measure === measure && !factors.includes(row.factor))
                        .reduce((sum, row) => sum + row.share, 0);
      return {
        measure: spaced(measure),
        factor: others,
        share: 100 * share,
        label: share < 0.07 ? "" : percent(share),
        text: percent(share)
      };
    });
    const rows = own.filter((row) => factors.includes(row.factor))
                     .map((row) => part(row, row.factor))
                     .concat(rest.some((row) => row.share > 0) ? rest : []),
          legend = [];
    [...factors.map((factor) => ricochet.shorten(factor)), others].forEach((name, k) => {
      if (!rows.some((row) => row.factor === name)) return;
      const colour = name === others ? grey : ricochet.lighten(ricochet.methodColours[k], 0.35);
      // Dark words on any screen, where the bars are bright: a colour by name is not carried over.
      ricochet.draw(
          out, rows, {x: "share", y: "measure"}, {
            mark: "bars",
            name,
            stack: "shares",
            thick: 34,
            colour,
            edge: 1,
            said: (row) => row.label,
            letters: name === others ? "#222222" : "black"
          },
          {factor: name});
      legend.push(ricochet.swatch(name, colour));
    });
    if (measures.some((measure) => told(measure) < 0.99))
      out.notes.push(
          "Where a bar ends before 100 %, choices of two levels and cases without a result leave the rest untold.");
    const used = new Set();
    factors.forEach((factor) => ricochet.shorten(factor, used));
    const key = used.size ? " " + ricochet.keyTo(used) + "." : "";
    return [{
      id: "shares",
      title: "Shares of the choices in what is observed",
      views: ["share of the variance"],
      legend,
      charts: [{title: "all cases", height: out.height, views: [out], notes: []}],
      caption:
          "Shares of the variance over all combinations, of one choice alone (a name) and of interactions (×); below " +
          "each its 95 % interval in %." + key,
    }];
  });
}

// Shares of variance per measure: one bar per factor or interaction with its interval.
{
  const mostBars = 12;
  const kinds = [["repeats", "#999999"], ["one choice", "#0072B2"], ["interaction of two", "#E69F00"], ["interaction of three", "#009E73"], ["higher interactions", "#CC79A7"]];
  const order = [1, 2, 3, 4, 0];   // of the kinds in legend and chart

  // Index into `kinds`.
  const kindOf = (factor) => (factor === "higher" ? 4 : factor === "repeats" ? 0 : factor.split(" × ").length);

  function chart(measure, shares) {
    const { percent, spaced } = ricochet.format, drawn = shares.slice(0, mostBars), name = spaced(measure.measure);
    const text = (share) => percent(share.share) + " [" + percent(share.low) + ", " + percent(share.high) + "]";
    const y = {
      type: "category", data: drawn.map((share) => share.factor), inverse: true, axisTick: { show: false }, axisLine: { show: true, lineStyle: { color: ricochet.faint } },
      axisLabel: { color: ricochet.ink, fontSize: 11, width: 150, overflow: "break", interval: 0 },
    };
    const x = ["share of the variance", "%"], out = ricochet.view(x, [measure.log ? "log₁₀ " + name : name, "1"], ricochet.valueAxis(x, new ricochet.Interval(0, 100), false), y);
    out.option.grid.left = 165;
    for (const kind of order) {
      const data = drawn.filter((share) => kindOf(share.factor) === kind).map((share) => ({ value: [100 * share.share, share.factor], text: text(share) })), [title, colour] = kinds[kind];
      if (data.length) out.option.series.push({ type: "bar", name: title, stack: "share", barWidth: "58%", color: colour, itemStyle: { color: ricochet.lighten(colour, 0.25) }, data });
    }
    for (const kind of order) {
      const ends = drawn.filter((share) => kindOf(share.factor) === kind).flatMap((share) => [share.low, share.high].map((end) => ({ value: [100 * end, share.factor], text: text(share) })).concat([{ value: ["-", share.factor] }]));
      if (ends.length) out.option.series.push({ type: "line", name: kinds[kind][0], symbol: "rect", symbolSize: [1.4, 9], z: 4, color: "#222222", lineStyle: { color: "#222222", width: 1.4 }, data: ends });
    }
    return out;
  }

  ricochet.figure("effects", (data) => {
    const charts = [], used = new Set();
    for (const measure of data.rows("effects_said")) {
      const shares = data.rows("effects").filter((row) => row.measure === measure.measure).sort((a, b) => b.share - a.share);
      if (!shares.length || !(shares[0].share > 0)) continue;
      const view = chart(measure, shares);
      if (measure.rest > 0) view.notes.push("Not drawn: " + measure.rest + " smaller, together " + ricochet.format.percent(measure.rest_share) + ".");
      charts.push({ title: ricochet.format.spaced(measure.measure), views: [view], notes: [measure.sentence] });
      shares.slice(0, mostBars).forEach((share) => used.add(kindOf(share.factor)));
    }
    if (!charts.length) return [];
    const caption = "Shares of the variance of a measure over all combinations of the choices: of one choice alone, and of interactions, where what one does depends on the others. " +
      "Lines: 95 % of the shares when levels are given random weights; wide where a share hangs on which levels the study holds.";
    return [{ id: "effects", title: "What each choice is worth", caption, views: ["share of the variance"], charts, legend: order.filter((kind) => used.has(kind)).map((kind) => ({ name: kinds[kind][0], colour: kinds[kind][1], dash: "", symbol: "rect" })) }];
  });
}

// Turns of the branches over prominence, one line per case: where the lines leave each other is what a step invents.
{
  const {Interval, methodColours} = ricochet;

  ricochet.figure("turns", (data) => {
    const rows = data.rows("turns");
    if (!data.page.branches || !rows.some((row) => row.folds > 0)) return [];
    const branches = new ricochet.Branches(data), byCase = data.rowsBy("turns", ["case"]),
          names = ricochet.distinct(branches.cases.map((one) => branches.refinedLabel(one)));
    const x = ["prominence", branches.parameter[1]], y = ["folds with at least that prominence", "1"],
          xs = new Interval().include(...rows.map((row) => row.prominence)), ys = new Interval(1, 1);
    const counted = (one) =>
        Array
            .from(
                ricochet.groupBy(byCase(one.id), (row) => [row.prominence]).values(),
                (own) => (
                    {case: one.id, prominence: own[0].prominence, folds: own.reduce((sum, row) => sum + row.folds, 0)}))
            .sort((a, b) => a.prominence - b.prominence);
    for (const one of branches.cases)
      ys.include(...counted(one).filter((row) => row.folds > 0).map((row) => row.folds));
    const charts = branches.methods().map(({label, cases}) => {
      const out = ricochet.view(x, y, ricochet.logAxis(x, xs), ricochet.logAxis(y, ys));
      for (const one of cases) {
        const name = branches.refinedLabel(one), k = names.indexOf(name),
              own = counted(one).filter((row) => row.folds > 0);
        if (own.length)
          ricochet.draw(
              out, own, {x: "prominence", y: "folds"},
              ricochet.curve({name, colour: methodColours[k % methodColours.length], style: k}, 6, 1.6));
      }
      return {title: label || "all cases", cases, views: [out], notes: []};
    });
    return [{
      id: "turns",
      title: "Turns of the branches over their prominence",
      views: ["folds"],
      charts,
      legend: names.map((name, k) => ({
                          name,
                          colour: methodColours[k % methodColours.length],
                          dash: ricochet.svgDash(k),
                          symbol: ricochet.symbol(k)
                        })),
      caption:
          "How many folds the branches of a case have whose parameter goes back by at least the prominence, before " +
          "and after. Lines that leave each other tell what a coarse step invents.",
    }];
  });
}

// Every order in the step that was fitted, by scheme, beside what the scheme declares.
{
  const mostRows = 24, verdicts = {
    confirmed: ["#009E73", "circle"],
    refuted: ["#D55E00", "diamond"],
    undecided: ["#8A8A8A", "triangle"]
  },
        none = "none declared", declared = "declared";

  ricochet.figure("order-dots", (data) => {
    const {view} = data,
          found = data.rows("orders").filter(
              (row) => row.refined === "step" && row.order !== null && data.byId.has(row.case)),
          cases = ricochet.distinct(found.map((row) => data.byId.get(row.case)));
    if (!found.length) return [];
    const outside = view.varyingWithout(["mass", "contact", "friction", "step", "elements"]),
          label = ricochet.rowLabels(view, cases, outside, mostRows);
    const rows =
        found.map((row) => ({
                    name: label(data.byId.get(row.case)),
                    order: row.order,
                    declared: row.declared,
                    verdict: verdicts[row.verdict] ? row.verdict : none,
                    text: row.error + ", " + view.label(data.byId.get(row.case), view.varyingWithout(["step"])) +
                        ": order " + ricochet.format.order(row.order) +
                        (row.low === null ?
                             "" :
                             " [" + ricochet.format.order(row.low) + ", " + ricochet.format.order(row.high) + "]") +
                        ", " + row.verdict,
                  }));
    const names = ricochet.distinct(rows.map((row) => row.name)),
          range = new ricochet.Interval().include(
              0, ...rows.map((row) => row.order), ...rows.map((row) => row.declared).filter((value) => value !== null));
    const x = ["order in the step", "1"],
          out = ricochet.namedRows(
              names, x, ricochet.valueAxis(x, ricochet.roundOutwards(range, 1)), names.length > 12 ? 18 : 24),
          legend = [];
    const ticks = rows.filter(
        (row, k) => row.declared !== null &&
            rows.findIndex((other) => other.name === row.name && other.declared === row.declared) === k);
    if (ticks.length) {
      ricochet.draw(
          out, ticks.map((row) => ({...row, text: "declared " + row.declared})), {x: "declared", y: "name"},
          ricochet.dot(declared, "#222222", "tick", 16, 2));
      legend.push(ricochet.swatch(declared, "#222222", "tick"));
    }
    for (const [verdict, [colour, symbol]] of [...Object.entries(verdicts), [none, ["#56B4E9", "circle"]]]) {
      if (!rows.some((row) => row.verdict === verdict)) continue;
      ricochet.draw(
          out, rows, {x: "order", y: "name"}, {...ricochet.dot(verdict, colour, symbol, 8), opacity: 0.75}, {verdict});
      legend.push(ricochet.swatch(verdict, colour, symbol));
    }
    return [{
      id: "order-dots",
      answers: true,
      title: "Orders found, and orders declared",
      views: ["order"],
      legend,
      charts: [{title: "all cases", height: out.height, views: [out], notes: []}],
      caption: "A mark per error and combination: the order in the step that was fitted." +
          (ticks.length ? " The black line is what the scheme declares." : ""),
    }];
  });
}

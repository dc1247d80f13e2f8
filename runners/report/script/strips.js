// Charts of a figure in rows: what several charts share stands once over them, and each says only what tells it from
// its neighbours. A chart's `part` tells apart those of the same cases.
{
  const {textOf, roleOf} = ricochet, widest = 4;

  // [{label, charts: [{chart, index, label}]}]; one strip without a label where nothing is shared.
  ricochet.strips = (charts) => {
    const listed = charts.map((chart, index) => ({chart, index, label: chart.title})),
          plain = [{label: "", charts: listed}];
    if (charts.length < 4 || charts.some((chart) => !chart.by || chart.only !== undefined)) return plain;
    const {view} = ricochet.data, first = ({cases: [one]}) => one,
          many = (columns) =>
              ricochet.groupBy(charts, (chart) => columns.map((column) => textOf(first(chart), column))).size;
    // The methods of a role vary together.
    const choices = Array.from(ricochet.groupBy(charts[0].by, (column) => [roleOf(column)]).values())
                        .filter((columns) => many(columns) > 1);
    if (choices.length < 2) return plain;
    // Beside each other stands the last choice that fits a row.
    const part = ({part: said = ""}) => said;
    const inner = choices.slice().reverse().find((columns) => many(columns) <= widest) || choices[choices.length - 1],
          outer = choices.filter((columns) => columns !== inner).flat();
    const label = (chart, columns) => view.label(first(chart), columns) || "–";
    const groups =
        ricochet.groupBy(listed, ({chart}) => [part(chart), ...outer.map((column) => textOf(first(chart), column))]);
    if (groups.size === charts.length) return plain;
    return Array.from(
        groups.values(), (own) => ({
                           label: [part(own[0].chart), label(own[0].chart, outer)].filter(Boolean).join(" · "),
                           charts: own.map((one) => ({...one, label: label(one.chart, inner)}))
                         }));
  };
}

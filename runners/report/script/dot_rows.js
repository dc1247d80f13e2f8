// Charts whose rows have names: bars, dots and bands along x. What shows an answer is drawn so.
{
  const rowHeight = 26, frame = 64, letter = 6.3;

  // A view of named rows, the first on top; `along` is the horizontal axis, `height` that of a row.
  ricochet.namedRows = (names, x, along, height = rowHeight) => {
    const longest = Math.max(0, ...names.map((name) => name.length)), most = window.innerWidth < 600 ? 130 : 250,
          width = Math.min(most, 14 + letter * longest), lines = Math.ceil(1.2 * letter * longest / most);
    const y = {
      type: "category",
      data: names,
      inverse: true,
      axisTick: {show: false},
      axisLine: {show: true, lineStyle: {color: ricochet.faint}},
      axisLabel: {color: ricochet.ink, fontSize: 11, lineHeight: 12, width: width - 10, overflow: "break", interval: 0},
    };
    const out = ricochet.view(x, ["", "1"], along, y);
    Object.assign(out.option.grid, {left: width + 4, right: 24});
    // Rows have no window: a drag along x would lose them.
    return Object.assign(out, {height: frame + Math.max(height, 12 * lines + 4) * names.length});
  };
  const dot = (name, colour, symbol, size, z = 3) =>
      ({type: "scatter", name, symbol, symbolSize: size, color: colour, itemStyle: {color: colour}, z});
  // A hollow one, which another fits into.
  const ring = (name, colour, size) =>
      ({...dot(name, colour, "circle", size), itemStyle: {color: "#ffffff", borderColor: colour, borderWidth: 1.6}});

  // Labels of cases for so many rows at most: by all columns given, else by the scheme with its parameters, else by its
  // name.
  ricochet.rowLabels = (view, cases, columns, rows) => {
    const schemes = view.varying.filter((column) => ricochet.roleOf(column) === "time");
    const tried = [columns, schemes, ["time"]].find((some) => view.group(cases, some).length <= rows) || [];
    return (one) =>
               ricochet.shorten(view.label(one, tried) || (tried.length ? ricochet.textOf(one, "time") : "all cases"));
  };
  Object.assign(ricochet, {dot, ring});
}

// Lines of fitted orders on logarithmic axes: pale, with the order at the end. Ends that lie near each other share a
// label, and no label covers another one, whatever the data and the fonts.
{
  const labelWidth = 0.45, labelHeight = 0.085;  // of a frame
  const lineHeight = 14;  // pixels; otherwise the library takes the width of a Chinese letter, which a font may lack
  const fittedLine = ({name, colour}, order) => ({
    type: "line",
    name,
    symbol: "none",
    z: 1,
    color: colour,
    lineStyle: {color: ricochet.lighten(colour, 0.72), width: 7, cap: "round"},
    labelLayout: {moveOverlap: "shiftY", hideOverlap: true},
    endLabel: {
      show: true,
      formatter: ricochet.format.order(order),
      color: colour,
      fontSize: 11,
      lineHeight,
      distance: 8,
    },
  });
  const cut = (list, along, gap) => list.sort((a, b) => a[along] - b[along]).reduce((groups, one) => {
    const last = groups[groups.length - 1];
    if (last && one[along] - last[last.length - 1][along] < gap) last.push(one);
    else groups.push([one]);
    return groups;
  }, []);

  class FittedLines {
    constructor(view) {
      this.view = view;
      this.ends = [];
      view.option.grid.right = 86;  // for "1.98 to 2.02"
    }
    // Two rows {x, y, text}, the named columns of which are drawn.
    draw(rows, encode, curve, order) {
      const [x, y] = [[].concat(this.view.option.xAxis)[0], [].concat(this.view.option.yAxis)[0]],
                share = (value, {min, max}) =>
                    Math.log(Math.min(Math.max(value, min), max) / min) / Math.log(max / min),
                end = rows[rows.length - 1], {series} = this.view.option;
      ricochet.draw(this.view, rows, encode, fittedLine(curve, order));
      this.ends.push({
        order,
        series: series[series.length - 1],
        place: share(end[encode.x], x),
        height: share(end[encode.y], y),
      });
    }
    // Once all are drawn.
    label() {
      const {order} = ricochet.format;
      for (const same of cut(this.ends, "place", labelWidth).flatMap((column) => cut(column, "height", labelHeight))) {
        const orders = same.map((one) => one.order), low = order(Math.min(...orders)),
              high = order(Math.max(...orders)), middle = same[same.length >> 1];
        for (const one of same)
          if (one !== middle) delete one.series.endLabel;
        if (same.length > 1)
          Object.assign(
              middle.series.endLabel, {formatter: low === high ? low : low + " to " + high, color: ricochet.ink});
      }
    }
  }

  ricochet.FittedLines = FittedLines;
}

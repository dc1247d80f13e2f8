// The case of the point or curve that lies where a chart was clicked. Rows that speak of a case carry its id, and so do
// curves whose rows are columns.
{
  const reach = 14;  // pixels

  // The rows of a series with what its filters leave of them.
  function rowsOf({dataset}, index) {
    const {source, fromDatasetIndex, transform} = dataset[index];
    if (source) return source;
    const {dimension, "=": value} = transform.config;
    return rowsOf({dataset}, fromDatasetIndex).filter((row) => row[dimension] === value);
  }
  function pixelsOf(chart, series) {
    const axes = {xAxisIndex: series.xAxisIndex || 0, yAxisIndex: series.yAxisIndex || 0};
    return (x, y) => (x === null || y === null ? [NaN, NaN] : chart.convertToPixel(axes, [x, y]));
  }
  // Distance of a place to the line between two.
  function toSegment([x, y], a, b) {
    const along = [b[0] - a[0], b[1] - a[1]], squared = along[0] * along[0] + along[1] * along[1];
    const share = squared > 0 ? Math.min(1, Math.max(0, ((x - a[0]) * along[0] + (y - a[1]) * along[1]) / squared)) : 0;
    return Math.hypot(x - a[0] - share * along[0], y - a[1] - share * along[1]);
  }

  // The first place of a rising list whose value is not below.
  function firstFrom(values, wanted) {
    let low = 0, high = values.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (values[middle] < wanted) low = middle + 1;
      else high = middle;
    }
    return low;
  }
  // Curves are over time, which rises: the samples around the place are enough, however many there are.
  function nearestOnCurve(chart, series, source, pixel, at, found) {
    const xs = source[series.encode.x], ys = source[series.encode.y],
          along = (x) => chart.convertFromPixel(
              {xAxisIndex: series.xAxisIndex || 0, yAxisIndex: series.yAxisIndex || 0}, [x, at[1]])[0];
    const last = Math.min(xs.length - 1, firstFrom(xs, along(at[0] + reach)));
    let before = null;
    for (let i = Math.max(0, firstFrom(xs, along(at[0] - reach)) - 1); i <= last; ++i) {
      const here = pixel(xs[i], ys[i]);
      if (before) found(toSegment(at, before, here), series.case);
      before = here;
    }
  }

  function caseAt({chart, drawn}, at) {
    let nearest = reach, id = null;
    const found = (distance, one) => {
      if (distance < nearest) {
        nearest = distance;
        id = one;
      }
    };
    for (const series of drawn.series) {
      if (series.datasetIndex === undefined || drawn.legend.selected[series.name] === false) continue;
      const rows = rowsOf(drawn, series.datasetIndex), pixel = pixelsOf(chart, series);
      if (!Array.isArray(rows)) {
        if (series.case) nearestOnCurve(chart, series, rows, pixel, at, found);
        continue;
      }
      for (const row of rows) {
        if (!row.case) continue;
        const [x, y] = pixel(row[series.encode.x], row[series.encode.y]);
        found(Math.hypot(at[0] - x, at[1] - y), row.case);
      }
    }
    return id;
  }

  ricochet.caseAt = caseAt;
  // Opens what lies there; says whether anything does.
  ricochet.pickCase = (slot, at) => {
    const id = slot.drawn && caseAt(slot, at);
    if (id) ricochet.showCase(ricochet.data, id);
    return Boolean(id);
  };
}

// Tables as charts draw them: rows are objects with a table's columns, and a series names the columns that it draws.
// Not drawn so: what is drawn by hand, pixel by pixel (the points of a diagram, the images of basins). Nor are lines
// and areas that mark a chart: the library takes no rows for these.
{
  // Draws rows. `encode` names the columns along x and y; `series` is how it looks. A row's `text`, where it has one,
  // is what hovering says of it. `only` {column: value} picks some of the rows, and draws nothing where there are none.
  // Long columns come as a function that returns them by name: it is asked when the chart is drawn.
  function draw({option}, rows, encode, series, only) {
    const {dataset} = option, known = dataset.findIndex((one) => one.source === rows);
    const dimensions = rows.length ? Object.keys(rows[0]) : Object.values(encode).flat();
    let datasetIndex = known < 0 ? dataset.push({source: rows, dimensions}) - 1 : known;
    for (const [dimension, value] of Object.entries(only || {})) {
      if (!rows.some((row) => row[dimension] === value)) return;
      datasetIndex =
          dataset.push({fromDatasetIndex: datasetIndex, transform: {type: "filter", config: {dimension, "=": value}}}) -
          1;
    }
    option.series.push({datasetIndex, encode, ...series});
  }
  // What a point that the library tells of has in the column along x or y.
  function cell({value: row, encode, dimensionNames}, along) {
    const [index] = (encode || {})[along] || [];
    return index === undefined ? undefined : row[Array.isArray(row) ? index : dimensionNames[index]];
  }

  // Two rows per row, at the two ends of a bar, and one that ends the line between them.
  const ends = (rows, low, high) => rows.flatMap((row) => [row[low], row[high], null].map((end) => ({...row, end})));

  // Marks of text, which the legend filters with the curve of their name.
  const textMark = ({name, colour}) => ({
    type: "scatter",
    name,
    symbol: "circle",
    symbolSize: 15,
    z: 5,
    itemStyle: {color: "rgba(255,255,255,0.7)"},
    label: {show: true, position: "inside", formatter: "{@mark}", color: colour, fontSize: 14, fontWeight: "bold"},
  });
  // Draws rows {at, height, mark, text} along the upper edge, on the gutter's axis.
  function drawMarks(view, curve, rows, more) {
    if (rows.length) draw(view, rows, {x: "at", y: "height"}, {...textMark(curve), yAxisIndex: 1, ...more});
  }
  // Height of the mark with `below` others above it, as a share of the frame.
  const markHeight = 0.085, markAt = (below) => 0.95 - markHeight * below;
  // Rows of marks for cases without a point: what stands at one place is stacked.
  function outcomeMarks() {
    const stacked = new Map();
    return (one, at) => {
      const below = stacked.get(at) || 0;
      stacked.set(at, below + 1);
      return {
        case: one.id,
        at,
        height: markAt(below),
        mark: ricochet.format.mark(one.status),
        text: one.status + ": " + one.reason
      };
    };
  }

  Object.assign(ricochet, {draw, cell, ends, textMark, drawMarks, markHeight, markAt, outcomeMarks});
}

// What the chart library holds of a figure, and what it painted.
(() => {
  "use strict";
  const all = (selector, from) => Array.from((from || document).querySelectorAll(selector));
  const mostItems = 3000;  // of a series that are read back one by one

  // Pixels with a hue: grey is axes and text.
  function coloured(slot) {
    const layers = all("canvas", slot.element), canvas = layers[0];
    if (!canvas || !canvas.width || !canvas.height) return 0;
    const copy = Object.assign(document.createElement("canvas"), {width: canvas.width, height: canvas.height}),
          context = copy.getContext("2d", {willReadFrequently: true});
    for (const layer of layers) context.drawImage(layer, 0, 0);
    const data = context.getImageData(0, 0, copy.width, copy.height).data;
    let count = 0;
    for (let i = 0; i < data.length; i += 4)
      if (data[i + 3] > 0 &&
          Math.max(data[i], data[i + 1], data[i + 2]) - Math.min(data[i], data[i + 1], data[i + 2]) > 24)
        ++count;
    return count;
  }

  // Pairs of words of a chart that lie on each other, read from what is painted. Single marks may: where they stand
  // says something.
  function collisions(chart) {
    const boxes = [], out = [];
    for (const part of chart.getZr().storage.getDisplayList(true)) {
      if (part.type !== "tspan" || part.invisible || !part.style.text || part.style.text.trim().length < 2 ||
          part.style.opacity === 0)
        continue;
      // Without a font of all scripts the library takes lines for lower than they are painted.
      const rect = part.getBoundingRect().clone(), size = 0.9 * parseFloat(/[\d.]+px/.exec(part.style.font)[0]);
      if (rect.height < size) {
        rect.y -= 0.5 * (size - rect.height);
        rect.height = size;
      }
      if (part.transform) rect.applyTransform(part.transform);
      boxes.push([part.style.text, rect.x + 1, rect.y + 1, rect.x + rect.width - 1, rect.y + rect.height - 1]);
    }
    boxes.forEach(([name, left, top, right, bottom], k) => {
      for (const [other, low, high, far, deep] of boxes.slice(k + 1))
        if (left < far && low < right && top < deep && high < bottom) out.push(name + " | " + other);
    });
    return out;
  }

  const pick = (from, names) => Object.fromEntries(
      names.filter((name) => from[name] !== undefined && from[name] !== null).map((name) => [name, from[name]]));
  // A point as the library has it: where it lies, and the words of its row. Also where it looks unlike a row with
  // nothing to tell.
  function itemOf(data, i, plain) {
    const along = (dimension) => {
      const {ordinalMeta} = data.getDimensionInfo(dimension), value = data.get(dimension, i);
      return ordinalMeta ? ordinalMeta.categories[value] : Number.isNaN(value) ? "-" : value;
    };
    // Sums of stacked bars are the library's own.
    const dimensions = ["x", "y"]
                           .flatMap((axis) => data.mapDimensionsAll(axis))
                           .filter((dimension) => !data.getDimensionInfo(dimension).isCalculationCoord);
    const out = {value: dimensions.map(along), ...pick(data.getRawDataItem(i), ["text", "mark"])};
    const {fill} = data.getItemVisual(i, "style") || {}, size = data.getItemVisual(i, "symbolSize");
    if (/^empty/.test(data.getItemVisual(i, "symbol"))) out.itemStyle = {color: "#ffffff"};
    else if (fill !== (data.getVisual("style") || {}).fill) out.itemStyle = {color: fill};
    if (String(size) !== String(plain)) out.symbolSize = size;
    return out;
  }
  const ofPlainRow = (setting) => (typeof setting === "function" ? setting({}) : setting);
  function seriesOf(series, model) {
    const out = pick(
              series,
              ["type", "name", "tags", "color", "itemStyle", "lineStyle", "xAxisIndex", "yAxisIndex", "z", "sampling"]),
          data = model.getData();
    Object.assign(out, {symbol: ofPlainRow(series.symbol), symbolSize: ofPlainRow(series.symbolSize)});
    out.count = data.count();  // after the library's own thinning
    out.given = model.getRawData().count();
    out.data = out.given <= mostItems ? Array.from({length: out.count}, (_, i) => itemOf(data, i, out.symbolSize)) : [];
    if (series.endLabel && series.endLabel.show) out.endLabel = series.endLabel.formatter;
    if (series.markLine) out.markLine = series.markLine.data;
    if (series.markArea) out.markArea = series.markArea.data;
    return out;
  }
  const seriesIn = (chart) =>
      chart.getOption().series.map((series, k) => seriesOf(series, chart.getModel().getSeriesByIndex(k)));
  function sourceOf(source) {
    const out =
        Object.assign(pick(source, ["what", "id", "group", "tags", "colour", "grid"]), {count: source.orbits.length});
    return Object.assign(out, source.what === "points" ? {} : {values: source.values});
  }
  function readBack(figure, slot) {
    const view = figure.viewOf(slot),
          out = {coloured: 0, notes: [], series: [], sources: view.sources ? view.sources().map(sourceOf) : []};
    if (!slot.chart) return out;
    slot.chart.getZr().flush();
    const option = slot.chart.getOption(),
          axis = (one) => pick(one, ["name", "type", "min", "max", "gridIndex", "data", "show"]);
    if (!option || !option.series) return out;
    out.coloured = coloured(slot);
    out.xAxis = option.xAxis.map(axis);
    out.yAxis = option.yAxis.map(axis);
    out.grid = option.grid.map((grid) => pick(grid, ["left", "right", "top", "height"]));
    out.dataZoom = option.dataZoom.map((zoom) => pick(zoom, ["id", "xAxisIndex", "filterMode"]));
    out.series = seriesIn(slot.chart);
    out.collisions = collisions(slot.chart);
    return out;
  }
  const notesIn = (figure, index, view) => all("figure", figure.section)[index] ?
      all(":scope > ul.notes li, :scope > div[data-notes]:not([hidden]) li", all("figure", figure.section)[index])
          .map((li) => li.textContent) :
      [];

  window.readback = {all, coloured, pick, seriesIn, sourceOf, readBack, notesIn};
})();

// A chart as a picture file: the same option once more off screen, with title and legend, in the renderer of the
// format.
{
  const symbols = {"triangle-down": "triangle", cross: "path://M0,0L10,10M10,0L0,10", "": "rect"};

  ricochet.picture = (figure, slot, format) => {
    const chart = figure.chartOf(slot), option = figure.option(slot), view = figure.viewOf(slot),
          {title, legend: entries} = figure.description;
    if (!option) return null;
    option.title = {
      text: chart.title === "all cases" ? title : title + ": " + chart.title,
      left: 12,
      top: 8,
      textStyle: {fontSize: 14, fontWeight: "normal", color: "#222"}
    };
    Object.assign(
        option.legend, {show: true, type: "plain", left: 12, top: 32, itemWidth: 34, textStyle: {fontSize: 11}});
    option.series.forEach((s) => {
      if (s.showSymbol === false) s.symbol = "none";
    });  // the legend shows symbols even where the curve has none
    // It takes the symbol of the first series of a name, and knows none that hangs on rows.
    option.series = option.series.flatMap(
        (s) =>
            (typeof s.symbol === "function" ?
                 [{...s, symbol: s.symbol({}), datasetIndex: undefined, encode: undefined, data: []}, s] :
                 [s]));
    let names = Array.from(new Set(option.series.map((s) => s.name))).filter((name) => name !== "stops");
    const tagged = new Set(option.series.concat(view.sources ? view.sources() : []).flatMap((s) => s.tags || []));
    if (tagged.size) {  // one entry per meaning instead of one per series
      const shown =
          entries.length < 2 ? [] : entries.filter((entry) => tagged.has(entry.name) && !figure.hidden.has(entry.name));
      names = shown.map((entry) => entry.name);
      for (const {name, colour, symbol} of shown)
        option.series.push({
          type: "scatter",
          name,
          symbol: symbols[symbol] || symbol,
          symbolRotate: symbol === "triangle-down" ? 180 : 0,
          color: colour,
          itemStyle: {color: colour},
          data: []
        });
      option.legend.itemWidth = 12;
    }
    option.legend.data = names;
    const legend = 58 + 20 * Math.ceil(names.reduce((sum, name) => sum + 60 + 6.2 * name.length, 0) / 860),
          size = {width: 900, height: 480};
    if (Array.isArray(option.grid)) {
      size.height = Math.max(...option.grid.map((g) => g.top + g.height)) + legend + 48;
      option.grid.forEach((g) => {
        g.top += legend;
      });
    } else option.grid.top = legend;
    delete option.toolbox;
    if (figure.zoom)
      Object.assign(option.dataZoom[0], {startValue: figure.zoom.startValue, endValue: figure.zoom.endValue});
    return format === "svg" ? asSvg(option, size) : asPng(option, size);
  };

  // The drawing of an option, as text.
  ricochet.drawing = (option, size) => {
    const chart = echarts.init(null, null, Object.assign({renderer: "svg", ssr: true}, size));
    chart.setOption(option);
    // Pictures inside (images of basins, clouds of points) fill the box that they are given.
    const text = chart.renderToSVGString().replace(/<image /g, '<image preserveAspectRatio="none" ');
    chart.dispose();
    return text;
  };
  const asSvg = (option, size) => new Blob([ricochet.drawing(option, size)], {type: "image/svg+xml"});
  function asPng(option, size) {
    const chart = echarts.init(
        document.createElement("div"), null, Object.assign({renderer: "canvas", devicePixelRatio: 3}, size));
    chart.setOption(option);
    chart.getZr().flush();
    const url = chart.getDataURL({type: "png", pixelRatio: 3, backgroundColor: "#fff"});
    chart.dispose();
    const binary = atob(url.slice(url.indexOf(",") + 1));
    return new Blob([Uint8Array.from(binary, (c) => c.charCodeAt(0))], {type: "image/png"});
  }
}

// The pieces of chart options that all figures share: axes, frames, dashes, symbols, marks.
{
  const ink = "#333333", faint = "#9a9a9a";
  const dashes = ["solid", [7, 4], [2, 3], [9, 3, 2, 3], [14, 5], [9, 3, 2, 3, 2, 3]];
  const symbols = ["circle", "rect", "triangle", "diamond", "roundRect", "arrow"];

  // An interval of an axis; empty until something is included.
  class Interval {
    constructor(low = 1, high = -1) { this.low = low; this.high = high; }
    get empty() { return !(this.low <= this.high); }
    include(...values) {
      for (const value of values) {
        if (!Number.isFinite(value)) continue;
        if (this.empty) this.low = this.high = value;
        else { this.low = Math.min(this.low, value); this.high = Math.max(this.high, value); }
      }
      return this;
    }
    join(other) { return other.empty ? this : this.include(other.low, other.high); }
    copy() { return new Interval(this.low, this.high); }
  }

  // Powers of ten to the last bit, which Math.pow does not give.
  const ten = (k) => Number("1e" + k);
  // Rounded outwards to a round step of about five ticks, at least `least` wide.
  function roundOutwards({ low, high }, least) {
    if (high - low < least) {
      const middle = 0.5 * (low + high);
      low = middle - 0.5 * least;
      high = middle + 0.5 * least;
    }
    const raw = (high - low) / 5, decade = ten(Math.floor(Math.log10(raw)));
    const step = decade * ([1, 2, 5].find((factor) => factor * decade >= raw) || 10);
    return new Interval(step * Math.floor(low / step + 1e-9), step * Math.ceil(high / step - 1e-9));
  }
  // Rounded outwards to whole decades; needs 0 < low.
  function wholeDecades(interval) {
    const low = Math.floor(Math.log10(interval.low) + 1e-9), high = Math.ceil(Math.log10(interval.high) - 1e-9);
    return new Interval(ten(low), ten(high <= low ? low + 1 : high));
  }
  // The intervals of small multiples, made equal so that they compare; one whose largest magnitude is over 4 times the median one keeps its own, so
  // that it does not flatten the others.
  function sharedFrames(ranges) {
    const magnitude = (range) => Math.max(Math.abs(range.low), Math.abs(range.high));
    const sizes = ranges.filter((range) => !range.empty).map(magnitude).sort((a, b) => a - b);
    const usual = sizes.length ? sizes[(sizes.length - 1) >> 1] : 0, apart = (range) => !range.empty && magnitude(range) > 4 * usual;
    const shared = new Interval();
    ranges.filter((range) => !apart(range)).forEach((range) => shared.join(range));
    return ranges.map((range) => ({ range: apart(range) ? range : shared, own: apart(range) }));
  }

  function axis(quantity, vertical) {
    return {
      name: ricochet.format.withUnit(quantity), nameLocation: "middle", nameGap: vertical ? 52 : 26, nameTextStyle: { color: ink, fontSize: 11 },
      axisLine: { show: true, lineStyle: { color: faint }, onZero: false }, axisTick: { show: true, lineStyle: { color: faint } },
      splitLine: { show: true, lineStyle: { color: "#ececec" } }, axisLabel: { color: ink, fontSize: 11, hideOverlap: true }, axisPointer: { label: { show: false } },
    };
  }
  function valueAxis(quantity, range, vertical) {
    const out = Object.assign(axis(quantity, vertical), { type: "value", scale: true });
    out.axisLabel.formatter = (value) => ricochet.format.shown(value);
    if (!range.empty) Object.assign(out, { min: range.low, max: range.high });
    return out;
  }
  function logAxis(quantity, range, vertical) {
    const decades = wholeDecades(range), out = Object.assign(axis(quantity, vertical), { type: "log", min: decades.low, max: decades.high });
    out.axisLabel.formatter = ricochet.format.power;
    if (Math.log10(decades.high / decades.low) < 6.5) Object.assign(out, { minorTick: { show: true, splitNumber: 9, length: 2 }, minorSplitLine: { show: false } });
    return out;
  }
  // A second vertical axis from 0 to 1 that places marks of cases without a value.
  const gutterAxis = () => ({ type: "value", min: 0, max: 1, show: false });

  function tooltip(x, y) {
    const { escape, shown, unit } = ricochet.format;
    const row = (p) => {
      const name = '<div class="tip-row">' + p.marker + escape(p.seriesName);
      if (p.data && p.data.text) return name + '</div><div class="tip-text">' + escape(p.data.text) + "</div>";
      return name + "<b>" + shown(p.value[1], 9) + escape(unit(y)) + "</b></div>";
    };
    return (given) => {
      const list = [].concat(given).filter((p) => Array.isArray(p.value));
      if (!list.length) return "";
      const head = escape(x[0]) + " = " + shown(list[0].value[0], 7) + escape(unit(x));
      return "<div>" + head + '</div><div class="fine">' + escape(y[0]) + "</div>" + list.map(row).join("");
    };
  }

  // A view of a chart: its option with grid, tooltip, hidden legend, zoom and text style; x and y are quantities. `along`: hovering reads all curves at
  // one x, and what lies outside the window is left out along x, so that zooming in shows every sample; never along y, where that would cut curves.
  function view(x, y, xAxis, yAxis, along = false) {
    return {
      x, y, notes: [],
      option: {
        animation: false, backgroundColor: "#ffffff", textStyle: { fontFamily: "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif" },
        grid: { left: 70, right: 18, top: 14, bottom: 44 }, legend: { show: false },
        tooltip: Object.assign({ trigger: along ? "axis" : "item", confine: true, transitionDuration: 0, formatter: tooltip(x, y), textStyle: { fontSize: 12, color: ink } },
          along ? { axisPointer: { type: "line", lineStyle: { color: faint } } } : {}),
        dataZoom: [
          { type: "inside", id: "along-x", xAxisIndex: 0, filterMode: along ? "filter" : "none", zoomOnMouseWheel: "shift", moveOnMouseMove: "shift", moveOnMouseWheel: false },
          { type: "inside", id: "along-y", yAxisIndex: 0, filterMode: "none", zoomOnMouseWheel: "alt", moveOnMouseMove: false, moveOnMouseWheel: false },
        ],
        xAxis, yAxis, series: [],
      },
    };
  }

  // Colour mixed with white: share 0 keeps it, 1 is white.
  const lighten = (colour, share) => "#" + [1, 3, 5].map((k) => {
    const value = parseInt(colour.slice(k, k + 2), 16);
    return Math.round(value + share * (255 - value)).toString(16).padStart(2, "0").toUpperCase();
  }).join("");

  // A line with marks on its points.
  function curve(name, colour, style, data, size = 8, width = 1.6) {
    return { type: "line", name, symbol: symbols[style % symbols.length], symbolSize: size, color: colour, itemStyle: { color: colour }, lineStyle: { color: colour, width, type: dashes[style % dashes.length] }, data };
  }
  // One text mark per item {value, mark, text}, which the legend filters with the curve `name`.
  function marks(name, colour, items) {
    return {
      type: "scatter", name, symbol: "circle", symbolSize: 15, z: 5, itemStyle: { color: "rgba(255,255,255,0.7)" },
      label: { show: true, position: "inside", color: colour, fontSize: 14, fontWeight: "bold" }, data: items.map((item) => Object.assign(item, { label: { formatter: item.mark } })),
    };
  }
  const hollow = (colour) => ({ color: "#ffffff", borderColor: colour, borderWidth: 1.6 });
  // Whether a sweep is drawn on a logarithmic axis: values above zero over a factor of fifty.
  const logarithmicSweep = (range) => range.low > 0 && range.high >= 50 * range.low;
  const slug = (column) => column.replace(/\./g, "-");

  Object.assign(ricochet, {
    Interval, roundOutwards, wholeDecades, sharedFrames, valueAxis, logAxis, gutterAxis, tooltip, view, lighten, curve, marks, hollow, slug, logarithmicSweep, ink, faint,
    dash: (k) => dashes[k % dashes.length],
    svgDash: (k) => { const dash = dashes[k % dashes.length]; return dash === "solid" ? "" : dash.join(" "); },
    symbol: (k) => symbols[k % symbols.length],
  });
}

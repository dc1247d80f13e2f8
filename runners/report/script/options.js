// The pieces of chart options that all figures share: axes, frames, dashes, symbols, marks.
{
  const ink = "#333333", faint = "#9a9a9a";
  const dashes = ["solid", [7, 4], [2, 3], [9, 3, 2, 3], [14, 5], [9, 3, 2, 3, 2, 3]];
  const symbols = ["circle", "rect", "triangle", "diamond", "roundRect", "arrow"];

  // An interval of an axis; empty until something is included.
  class Interval {
    constructor(low = 1, high = -1) {
      this.low = low;
      this.high = high;
    }
    get empty() { return !(this.low <= this.high); }
    include(...values) {
      for (const value of values) {
        if (!Number.isFinite(value)) continue;
        if (this.empty) this.low = this.high = value;
        else {
          this.low = Math.min(this.low, value);
          this.high = Math.max(this.high, value);
        }
      }
      return this;
    }
    join(other) { return other.empty ? this : this.include(other.low, other.high); }
    copy() { return new Interval(this.low, this.high); }
  }

  const mostLabels = 6;  // of a logarithmic axis
  // Powers of ten to the last bit, which Math.pow does not give.
  const ten = (k) => Number("1e" + k);
  // Rounded outwards to a round step of about five ticks, at least `least` wide.
  function roundOutwards({low, high}, least) {
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
  // The intervals of small multiples, made equal so that they compare. One whose largest magnitude is over 4 times the
  // median one keeps its own: it would flatten the others. On a logarithmic axis none is flattened.
  function sharedFrames(ranges, logarithmic = false) {
    const magnitude = (range) => Math.max(Math.abs(range.low), Math.abs(range.high));
    const sizes = ranges.filter((range) => !range.empty).map(magnitude).sort((a, b) => a - b);
    const usual = sizes.length ? sizes[(sizes.length - 1) >> 1] : 0,
          apart = (range) => !logarithmic && !range.empty && magnitude(range) > 4 * usual;
    const shared = new Interval();
    ranges.filter((range) => !apart(range)).forEach((range) => shared.join(range));
    return ranges.map((range) => ({range: apart(range) ? range : shared, own: apart(range)}));
  }

  // Edges of cells around values, half-way between them on the scale of their axis; `alone` is half the width of a
  // single one.
  function cellEdges(values, logarithmic, alone = 0.5) {
    const at = logarithmic ? values.map(Math.log) : values, n = at.length,
          half = (k) => (n > 1 ? 0.5 * (at[k + 1] - at[k]) : alone);
    const out = [at[0] - half(0), ...at.slice(1).map((value, k) => 0.5 * (at[k] + value)), at[n - 1] + half(n - 2)];
    return logarithmic ? out.map(Math.exp) : out;
  }

  function axis(quantity, vertical) {
    return {
      name: ricochet.format.withUnit(quantity),
      nameLocation: "middle",
      nameGap: vertical ? 52 : 26,
      nameTextStyle: {color: ink, fontSize: 11},
      axisLine: {show: true, lineStyle: {color: faint}, onZero: false},
      axisTick: {show: true, lineStyle: {color: faint}},
      splitLine: {show: true, lineStyle: {color: "#ececec"}},
      axisLabel: {color: ink, fontSize: 11, hideOverlap: true},
      axisPointer: {label: {show: false}},
    };
  }
  function valueAxis(quantity, range, vertical) {
    const out = Object.assign(axis(quantity, vertical), {type: "value", scale: true});
    out.axisLabel.formatter = (value) => ricochet.format.shown(value);
    if (!range.empty) Object.assign(out, {min: range.low, max: range.high});
    return out;
  }
  function logAxis(quantity, range, vertical) {
    const decades = wholeDecades(range),
          out = Object.assign(axis(quantity, vertical), {type: "log", min: decades.low, max: decades.high});
    out.axisLabel.formatter = ricochet.format.power;
    // Whole powers at even distances, from the lowest on.
    const count = Math.round(Math.log10(decades.high / decades.low));
    if (count > mostLabels) {
      out.interval = Math.ceil(count / mostLabels);
      out.axisLabel.showMaxLabel = count % out.interval === 0;
    }
    if (Math.log10(decades.high / decades.low) < 6.5)
      Object.assign(out, {minorTick: {show: true, splitNumber: 9, length: 2}, minorSplitLine: {show: false}});
    return out;
  }
  const axisOf = (logarithmic, quantity, range, vertical) =>
      (logarithmic ? logAxis : valueAxis)(quantity, range, vertical);
  // A vertical axis whose name says where it does not begin at zero.
  function heightAxis(quantity, range) {
    const fromZero = range.low <= 0 && range.high >= 0;
    return valueAxis([ricochet.format.withUnit(quantity) + (fromZero ? "" : ", axis not from 0"), "1"], range, true);
  }
  // The ends of an axis are no round numbers: nothing to read there.
  const withoutEnds = (axis) => {
    axis.axisLabel.showMinLabel = axis.axisLabel.showMaxLabel = false;
  };
  // A second vertical axis from 0 to 1 that places marks of cases without a value.
  const gutterAxis = () => ({type: "value", min: 0, max: 1, show: false});

  // `series`: those of the chart, where rows that are columns have their case.
  function tooltip(x, y, series) {
    const {escape, shown, unit} = ricochet.format, {cell} = ricochet;
    const caseOf = (p) => (p.value && p.value.case) || (series[p.seriesIndex] || {}).case;
    const row = (p) => {
      const name = '<div class="tip-row">' + p.marker + escape(p.seriesName), {text} = p.value;
      return name +
          (text ? '</div><div class="tip-text">' + escape(text) + "</div>" :
                  "<b>" + shown(cell(p, "y"), 9) + escape(unit(y)) + "</b></div>");
    };
    return (given) => {
      const list = [].concat(given).filter((p) => cell(p, "x") !== undefined);
      if (!list.length) return "";
      const head = escape(x[0]) + " = " + shown(cell(list[0], "x"), 7) + escape(unit(x));
      const cases = ricochet.distinct(list.map(caseOf).filter(Boolean)),
            named = cases.length ? '<div class="fine">' + (cases.length > 1 ? "cases " : "case ") +
              escape(cases.join(", ")) + "; click: all of it</div>" :
                                   "";
      return "<div>" + head + '</div><div class="fine">' + escape(y[0]) + "</div>" + list.map(row).join("") + named;
    };
  }

  // A view of a chart: its option with grid, tooltip, hidden legend, zoom and text style; x and y are quantities.
  // `along`: hovering reads all curves at one x. What lies outside the window is then left out along x: zooming in
  // shows every sample. It is never left out along y, where that would cut curves.
  function view(x, y, xAxis, yAxis, along = false) {
    const series = [];
    return {
      x,
      y,
      notes: [],
      option: {
        animation: false,
        backgroundColor: "#ffffff",
        textStyle: {fontFamily: "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif"},
        grid: {left: 70, right: 18, top: 14, bottom: 44},
        legend: {show: false},
        tooltip: Object.assign(
            {
              trigger: along ? "axis" : "item",
              confine: true,
              transitionDuration: 0,
              formatter: tooltip(x, y, series),
              textStyle: {fontSize: 12, color: ink}
            },
            along ? {axisPointer: {type: "line", lineStyle: {color: faint}}} : {}),
        dataZoom: [
          {
            type: "inside",
            id: "along-x",
            xAxisIndex: 0,
            filterMode: along ? "filter" : "none",
            zoomOnMouseWheel: "shift",
            moveOnMouseMove: "shift",
            moveOnMouseWheel: false
          },
          {
            type: "inside",
            id: "along-y",
            yAxisIndex: 0,
            filterMode: "none",
            zoomOnMouseWheel: "alt",
            moveOnMouseMove: false,
            moveOnMouseWheel: false
          },
        ],
        xAxis,
        yAxis,
        dataset: [],
        series,
      },
    };
  }

  // Colour mixed with white: share 0 keeps it, 1 is white.
  const lighten = (colour, share) => "#" +
      [1, 3, 5]
          .map((k) => {
            const value = parseInt(colour.slice(k, k + 2), 16);
            return Math.round(value + share * (255 - value)).toString(16).padStart(2, "0").toUpperCase();
          })
          .join("");

  // A line with marks on its points.
  const curve = ({name, colour, style}, size = 8, width = 1.6) => ({
    type: "line",
    name,
    symbol: symbols[style % symbols.length],
    symbolSize: size,
    color: colour,
    lineStyle: {width, type: dashes[style % dashes.length]},
  });
  // The same with hollow marks where a row says so.
  function hollowCurve(one, rows, size, width) {
    const out = curve(one, size, width), full = out.symbol, empty = "empty" + full[0].toUpperCase() + full.slice(1);
    return rows.some((row) => row.hollow) ? {...out, symbol: (row) => (row.hollow ? empty : full)} : out;
  }
  // A line without marks.
  const line = (name, colour, width, type = "solid") =>
      ({type: "line", name, symbol: "none", z: 1, color: colour, lineStyle: {width, type}});
  // Whether numbers above zero over some factor are drawn on a logarithmic axis: nine for the values of a study's axis,
  // fifty for a sweep.
  const logarithmicAxis = (range) => range.low > 0 && range.high >= 9 * range.low,
        logarithmicSweep = (range) => range.low > 0 && range.high >= 50 * range.low;
  const slug = (column) => column.replace(/\./g, "-");

  // The names of the series in some charts.
  const drawnNames = (charts) =>
      new Set(charts.flatMap((chart) => chart.views.flatMap((one) => one.option.series.map((series) => series.name))));
  // An entry of a legend without a line; entries of which the first of each name stays.
  const swatch = (name, colour, symbol = "rect", heading) => ({name, colour, dash: "0 30", symbol, heading});
  const firstOfName = (entries) =>
      entries.filter((entry, k) => entries.findIndex((other) => other.name === entry.name) === k);

  Object.assign(ricochet, {
    Interval,
    roundOutwards,
    wholeDecades,
    cellEdges,
    sharedFrames,
    valueAxis,
    logAxis,
    axisOf,
    heightAxis,
    withoutEnds,
    gutterAxis,
    view,
    lighten,
    curve,
    hollowCurve,
    line,
    slug,
    logarithmicAxis,
    logarithmicSweep,
    drawnNames,
    swatch,
    firstOfName,
    ink,
    faint,
    unseenZeros: "Exactly 0, which a logarithmic axis cannot show: ",
    ownScale: "This chart has its own scale: its values are over 4 times those of most others.",
    dash: (k) => dashes[k % dashes.length],
    svgDash: (k) => {
      const dash = dashes[k % dashes.length];
      return dash === "solid" ? "" : dash.join(" ");
    },
    symbol: (k) => symbols[k % symbols.length],
  });
}

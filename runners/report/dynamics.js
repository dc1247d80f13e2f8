// Diagrams of many orbits: builds their series out of the page's blocks, finds the orbit under a click, and shows it beside the page.
const ricochetDynamics = (function () {
  "use strict";
  let page = null, data = null;
  const made = new Map();

  function start(tools) { page = tools; data = tools.read("dynamics-data"); }
  const orbitsOf = (id) => data.cases[id];
  const cell = (one, name, o) => { const column = one.columns[name]; return column ? column[o] : null; };
  const unitText = (quantity) => (quantity[1] === "" || quantity[1] === "1" ? "" : " " + quantity[1]);
  const block = (id, name) => page.block(id + "/" + name);

  // ---- series -------------------------------------------------------------------------------------------------------
  function chosen(reference, one) {
    const list = [];
    for (let o = 0; o < one.group.length; ++o)
      if ((reference.group === undefined || one.group[o] === reference.group) && (reference.kind === undefined || one.kind[o] === reference.kind)) list.push(o);
    return list;
  }
  const finite = (value) => typeof value === "number" && Number.isFinite(value);
  const makers = {
    points(reference, one) {
      const wanted = new Uint8Array(one.group.length), parameter = one.columns.parameter;
      chosen(reference, one).forEach((o) => { wanted[o] = 1; });
      const orbit = block(reference.case, "points/orbit"), u = block(reference.case, "points/u");
      if (!orbit) return { values: new Float64Array(0), orbits: [] };
      let n = 0;
      for (let i = 0; i < orbit.length; ++i) n += wanted[orbit[i]];
      const values = new Float64Array(2 * n), orbits = new Uint32Array(n);
      for (let i = 0, k = 0; i < orbit.length; ++i) {
        if (!wanted[orbit[i]]) continue;
        values[2 * k] = parameter[orbit[i]];
        values[2 * k + 1] = u[i];
        orbits[k++] = orbit[i];
      }
      return { values, orbits };
    },
    column(reference, one, name) {
      const list = chosen(reference, one).filter((o) => finite(cell(one, name, o)));
      const values = new Float64Array(2 * list.length);
      list.forEach((o, k) => { values[2 * k] = one.columns.parameter[o]; values[2 * k + 1] = one.columns[name][o]; });
      return { values, orbits: list };
    },
    exponents(reference, one) { return makers.column(reference, one, "exponent_" + reference.index); },
    twins(reference, one) { return makers.column(reference, one, "exponent_twin"); },
    whiskers(reference, one) {
      const name = "exponent_" + reference.index;
      const list = chosen(reference, one).filter((o) => finite(cell(one, name + "_low", o)) && finite(cell(one, name + "_high", o)));
      return { ends: Float64Array.from(list.flatMap((o) => [one.columns.parameter[o], one.columns[name + "_low"][o], one.columns[name + "_high"][o]])) };
    },
    marks(reference, one) {
      const rows = [], orbits = [];
      for (const o of chosen(reference, one)) {
        const status = cell(one, "status", o);
        if (!status || status === "done") continue;
        const mark = { refused: "⊘", diverged: "✕", failed: "!" }[status] || "?";
        rows.push({ value: [one.columns.parameter[o], 0.03], mark, label: { formatter: mark }, text: status + ": " + (cell(one, "reason", o) || "no reason given") });
        orbits.push(o);
      }
      return { rows, orbits };
    },
  };
  function cells(reference) {
    const rows = [], orbits = [], ids = [];
    reference.lanes.forEach(([id, name], lane) => {
      const one = orbitsOf(id), starts = one.columns.start;
      for (let o = 0; o < starts.length; ++o)
        if (starts[o] === name && one.group[o] === reference.group) { rows.push([one.from[o], one.to[o], lane]); orbits.push(o); ids.push(id); }
    });
    return { rows, orbits, ids };
  }
  // Cells of one label (or of one outcome of a comparison) in its colour, the others clear; several pixels a cell, so that edges stay sharp.
  function image(reference) {
    const own = block(reference.case, "cells"), other = reference.other === undefined ? null : block(reference.other, "cells");
    const undecided = new Set(reference.undecided || []), known = (k) => k !== 255 && !undecided.has(k);
    const wanted = (i) => (other ? (known(own[i]) && known(other[i]) ? (own[i] === other[i] ? 1 : 0) : 2) === reference.differs : own[i] === reference.label);
    const each = Math.max(1, Math.ceil(1000 / Math.max(reference.columns, reference.rows)));
    const canvas = Object.assign(document.createElement("canvas"), { width: each * reference.columns, height: each * reference.rows }), context = canvas.getContext("2d");
    context.fillStyle = reference.colour;
    for (let row = 0; row < reference.rows; ++row) {
      for (let from = 0; from < reference.columns;) {
        let to = from;
        while (to < reference.columns && wanted(row * reference.columns + to)) ++to;
        if (to > from) context.fillRect(each * from, each * (reference.rows - 1 - row), each * (to - from), each);
        from = Math.max(to, from + 1);
      }
    }
    return { rows: [reference.bounds], canvas };
  }
  function make(reference, option) {
    if (reference.sweep === "image") return image(reference);
    if (reference.sweep === "cells") return cells(reference);
    if (reference.sweep === "zero") return { rows: [[option.xAxis[0].min, 0], [option.xAxis[0].max, 0]] };
    return makers[reference.sweep](reference, orbitsOf(reference.case));
  }
  // Completes the series that refer to orbits. Points and whiskers are drawn by hand, all of a panel in one picture: the library is told of them
  // no more, as many series of it are slow. `view.sources` then says what is drawn of which orbit, `view.bySeries` the same by the library's series.
  function dress(view, option, hidden) {
    const kept = [], grids = new Map();
    view.sources = [];
    view.bySeries = [];
    delete option.cells;  // ours, not the library's
    for (const series of option.series) {
      if (series.symbol === "triangle-down") Object.assign(series, { symbol: "triangle", symbolRotate: 180 });
      const reference = series.data;
      if (!reference || typeof reference.sweep !== "string") { kept.push(series); view.bySeries.push(null); continue; }
      const key = JSON.stringify(reference);
      if (!made.has(key)) made.set(key, make(reference, option));
      const built = made.get(key), grid = series.xAxisIndex || 0, axis = series.yAxisIndex || 0;
      const source = Object.assign({ reference, grid, axis, tags: series.tags || [], z: series.z || 2, colour: series.color }, built);
      view.sources.push(source);
      if (built.values) {
        source.glyph = glyphOf(series, reference, built.values.length / 2);
        if (source.glyph.shape === "cross") source.colour = series.itemStyle.borderColor;
      } else if (built.ends) {
        source.glyph = { shape: "whisker", size: 1 };
        source.colour = series.lineStyle.color;
      } else {
        kept.push(Object.assign(series, { data: built.rows }));
        view.bySeries.push(source);
        continue;
      }
      grids.set(grid, axis);
    }
    for (const [grid, axis] of grids) {
      kept.push({ type: "custom", name: "points of panel " + grid, xAxisIndex: grid, yAxisIndex: axis, silent: true, clip: true, progressive: 0, z: 3, renderItem: drawPoints(view, option, hidden, grid), encode: { x: 0, y: 1 },
        data: [[option.xAxis[grid].min, 0]] });
      view.bySeries.push(null);
    }
    option.series = kept;
  }

  // ---- points, pixel by pixel ---------------------------------------------------------------------------------------
  // Shape and size in CSS pixels. Starts are told apart by their marks while these are few; clouds are dots.
  function glyphOf(series, reference, count) {
    const shape = series.symbolRotate === 180 ? "down" : { triangle: "up", rect: "square", diamond: "diamond" }[series.symbol] || (String(series.symbol).startsWith("path:") ? "cross" : "circle");
    if (reference.sweep === "points") return count > 2500 ? { shape: "dot", size: count > 40000 ? 1.5 : 2 } : { shape, size: count < 400 ? 6 : 5 };
    return { shape, size: series.symbolSize || 4 };
  }
  // Coverage of the shape, 0 to 255, in device pixels around its centre. Kept: pixels are slow to read back.
  const masks = new Map();
  function maskOf(glyph, ratio) {
    const key = glyph.shape + glyph.size + "/" + ratio;
    if (!masks.has(key)) masks.set(key, makeMask(glyph, ratio));
    return masks.get(key);
  }
  function makeMask(glyph, ratio) {
    const size = Math.max(1, Math.round(glyph.size * ratio));
    if (glyph.shape === "dot") return { size, alpha: new Uint8Array(size * size).fill(255) };
    const canvas = Object.assign(document.createElement("canvas"), { width: size, height: size }), c = canvas.getContext("2d"), h = size / 2;
    c.beginPath();
    if (glyph.shape === "circle") c.arc(h, h, h, 0, 7);
    else if (glyph.shape === "square") c.rect(0.5, 0.5, size - 1, size - 1);
    else if (glyph.shape === "up") { c.moveTo(h, 0); c.lineTo(size, size); c.lineTo(0, size); }
    else if (glyph.shape === "down") { c.moveTo(h, size); c.lineTo(size, 0); c.lineTo(0, 0); }
    else if (glyph.shape === "diamond") { c.moveTo(h, 0); c.lineTo(size, h); c.lineTo(h, size); c.lineTo(0, h); }
    else { c.moveTo(0, 0); c.lineTo(size, size); c.moveTo(size, 0); c.lineTo(0, size); }
    if (glyph.shape === "cross") c.stroke(); else c.fill();
    const data = c.getImageData(0, 0, size, size).data, alpha = new Uint8Array(size * size);
    for (let i = 0; i < alpha.length; ++i) alpha[i] = data[4 * i + 3];
    return { size, alpha };
  }
  function drawWhiskers(source, words, wide, tall, across, up) {
    const [r, g, b] = [1, 3, 5].map((k) => parseInt(source.colour.slice(k, k + 2), 16)), ink = (255 << 24) | (b << 16) | (g << 8) | r;
    for (let i = 0; i < source.ends.length; i += 3) {
      const u = Math.floor(across(source.ends[i])), from = Math.max(0, Math.floor(up(source.ends[i + 2]))), to = Math.min(tall - 1, Math.floor(up(source.ends[i + 1])));
      if (u < 0 || u >= wide) continue;
      for (let v = from; v <= to; ++v) words[v * wide + u] = ink;
    }
  }
  const drawPoints = (view, option, hidden, grid) => (params, api) => {
    const frame = params.coordSys, ratio = api.getDevicePixelRatio(), wide = Math.round(frame.width * ratio), tall = Math.round(frame.height * ratio);
    if (wide < 1 || tall < 1) return null;
    const x = option.xAxis[grid], bend = x.type === "log" ? Math.log : (v) => v, low = bend(x.min), high = bend(x.max);
    const first = api.coord([x.min, 0]), last = api.coord([x.max, 1]);
    const left = (first[0] - frame.x) * ratio, perX = (last[0] - first[0]) * ratio / (high - low), zero = (first[1] - frame.y) * ratio, perY = (last[1] - first[1]) * ratio;
    const canvas = Object.assign(document.createElement("canvas"), { width: wide, height: tall }), context = canvas.getContext("2d");
    const picture = context.createImageData(wide, tall), bytes = picture.data, words = new Uint32Array(bytes.buffer);
    const drawn = view.sources.filter((s) => s && s.glyph && s.grid === grid && !s.tags.some((tag) => hidden.has(tag))).sort((a, b) => a.z - b.z);
    for (const source of drawn) {
      if (source.ends) { drawWhiskers(source, words, wide, tall, (v) => left + (bend(v) - low) * perX, (v) => zero + v * perY); continue; }
      const mask = maskOf(source.glyph, ratio), size = mask.size, alpha = mask.alpha, half = size / 2;
      const [r, g, b] = [1, 3, 5].map((k) => parseInt(source.colour.slice(k, k + 2), 16)), values = source.values;
      if (source.glyph.shape === "dot") {
        const ink = (255 << 24) | (b << 16) | (g << 8) | r, from = left - half + 0.5, base = zero - half + 0.5, straight = x.type !== "log";
        for (let i = 0; i < values.length; i += 2) {
          const px = Math.floor(from + ((straight ? values[i] : Math.log(values[i])) - low) * perX), py = Math.floor(base + values[i + 1] * perY);
          if (px < 0 || py < 0 || px + size > wide || py + size > tall) continue;
          for (let row = 0, at = py * wide + px; row < size; ++row, at += wide) for (let column = 0; column < size; ++column) words[at + column] = ink;
        }
        continue;
      }
      for (let i = 0; i < values.length; i += 2) {
        const px = Math.round(left + (bend(values[i]) - low) * perX - half), py = Math.round(zero + values[i + 1] * perY - half);
        if (px <= -size || py <= -size || px >= wide || py >= tall) continue;
        for (let row = 0; row < size; ++row) {
          const v = py + row;
          if (v < 0 || v >= tall) continue;
          for (let column = 0; column < size; ++column) {
            const u = px + column, a = alpha[row * size + column];
            if (u < 0 || u >= wide || a === 0) continue;
            const at = 4 * (v * wide + u), under = bytes[at + 3];
            if (a === 255 || under === 0) { bytes[at] = r; bytes[at + 1] = g; bytes[at + 2] = b; bytes[at + 3] = Math.max(a, under); continue; }
            const share = a / 255;
            bytes[at] += (r - bytes[at]) * share; bytes[at + 1] += (g - bytes[at + 1]) * share; bytes[at + 2] += (b - bytes[at + 2]) * share; bytes[at + 3] = Math.max(a, under);
          }
        }
      }
    }
    context.putImageData(picture, 0, 0);
    return { type: "image", silent: true, style: { image: canvas, x: frame.x, y: frame.y, width: frame.width, height: frame.height } };
  };
  function drawCell(params, api) {
    const low = api.coord([api.value(0), api.value(2)]), high = api.coord([api.value(1), api.value(2)]);
    const tall = api.size([0, 1])[1], frame = params.coordSys;
    const left = Math.max(low[0], frame.x), right = Math.min(high[0], frame.x + frame.width);
    if (right <= left) return null;
    // Whole pixels, so that neighbours of one colour leave no seam and the narrowest cell is seen.
    const from = Math.floor(left), to = Math.max(Math.floor(right), from + 1);
    return { type: "rect", shape: { x: from, y: low[1] - tall / 2 + 0.5, width: to - from, height: Math.max(tall - 1, 1) }, style: { fill: api.visual("color") } };
  }

  const drawImage = (view) => (params, api) => {
    const low = api.coord([api.value(0), api.value(2)]), high = api.coord([api.value(1), api.value(3)]);
    return { type: "image", style: { image: view.bySeries[params.seriesIndex].canvas, x: low[0], y: high[1], width: high[0] - low[0], height: low[1] - high[1] } };
  };

  // ---- words --------------------------------------------------------------------------------------------------------
  function regime(one, o) {
    const status = cell(one, "status", o);
    if (status && status !== "done") return status;
    const name = cell(one, "class", o) || "undecided", period = cell(one, "period", o);
    return name === "periodic" && period ? "period " + period : name;
  }
  function interval(one, name, o) {
    const value = cell(one, name, o), low = cell(one, name + "_low", o), high = cell(one, name + "_high", o);
    if (!finite(value)) return "";
    return page.number(value, 4) + (finite(low) && finite(high) ? " (" + page.number(low, 4) + " to " + page.number(high, 4) + ")" : "") + " 1/s";
  }
  function tooltip(view) {
    const line = (name, value) => '<div class="tip-row">' + page.escapeText(name) + "<b>" + page.escapeText(value) + "</b></div>";
    return (given) => {
      const p = Array.isArray(given) ? given[0] : given;
      if (!p || p.value === undefined || p.value === null) return "";
      if (p.data && p.data.text) return "<div>" + page.escapeText(view.x[0]) + " = " + page.number(p.value[0], 8) + '</div><div class="tip-row">' + page.escapeText(p.seriesName) + '</div><div class="tip-text">' + page.escapeText(p.data.text) + "</div>";
      const source = view.bySeries && view.bySeries[p.seriesIndex], o = source && source.orbits ? source.orbits[p.dataIndex] : undefined;
      const head = (x) => "<div>" + page.escapeText(view.x[0]) + " = " + page.number(x, 9) + page.escapeText(unitText(view.x)) + "</div>";
      if (o === undefined) return head(p.value[0]) + line(p.seriesName, page.number(p.value[1], 8));
      const id = source.ids ? source.ids[p.dataIndex] : source.reference.case;
      return wordsOf(view, id, o);
    };
  }
  function wordsOf(view, id, o, value) {
    const line = (name, text) => '<div class="tip-row">' + page.escapeText(name) + "<b>" + page.escapeText(text) + "</b></div>", one = orbitsOf(id);
    let out = "<div>" + page.escapeText(view.x[0]) + " = " + page.number(one.columns.parameter[o], 9) + page.escapeText(unitText(view.x)) + "</div>";
    if (one.label) out += '<div class="fine">' + page.escapeText(one.label) + "</div>";
    out += line(regime(one, o), "start " + cell(one, "start", o));
    if (value !== undefined) out += line(view.y[0], page.number(value, 8) + unitText(view.y));
    if (interval(one, "exponent_1", o)) out += line("exponent", interval(one, "exponent_1", o));
    return out;
  }
  // What lies under the mouse: points are pixels of a picture, which the library knows nothing of.
  let tip = null;
  function hover(chart, view, option, hidden, at, where) {
    const found = pick(chart, view, option, hidden, at, true);
    if (!found) { leave(); return; }
    if (!tip) { tip = element("div", "orbit-tip"); document.body.appendChild(tip); }
    tip.innerHTML = wordsOf(view, found.id, found.orbit, found.value) + '<div class="fine">click: its orbit</div>';
    tip.style.left = Math.max(0, Math.min(where[0] + 14, window.innerWidth - 300)) + "px";
    tip.style.top = Math.max(0, Math.min(where[1] + 14, window.innerHeight - 140)) + "px";
  }
  function leave() { if (tip) tip.remove(); tip = null; }

  // The cell of a grid of basins at a place of its image.
  function cellAt(view, chart, at) {
    const about = view.option.cells, image = about && view.sources.find((source) => source.reference.sweep === "image");
    if (!image) return null;
    const place = chart.convertFromPixel({ xAxisIndex: 0, yAxisIndex: 0 }, at), b = image.reference.bounds, columns = about.xs.length, rows = about.ys.length;
    const column = Math.floor((place[0] - b[0]) / (b[1] - b[0]) * columns), row = Math.floor((place[1] - b[2]) / (b[3] - b[2]) * rows);
    return column < 0 || row < 0 || column >= columns || row >= rows ? null : { id: image.reference.case, column, row };
  }
  // What it ends in: name and colour.
  function endOf(about, id, place) {
    return about.labels[block(id, "cells")[place.row * about.xs.length + place.column]] || ["not known yet", "#fff"];
  }
  const cellWords = (view, place) => [view.x[0] + " = " + view.option.cells.xs[place.column] + unitText(view.x), view.y[0] + " = " + view.option.cells.ys[place.row] + unitText(view.y)];
  function cellTooltip(view) {
    return (given) => {
      const p = Array.isArray(given) ? given[0] : given, source = view.bySeries && p && view.bySeries[p.seriesIndex];
      const mouse = view.mouse, reference = source && source.reference;
      if (!reference || !mouse) return p && p.value ? page.escapeText(view.x[0]) + " = " + page.number(p.value[0], 6) : "";
      const place = cellAt(view, mouse.chart, mouse.at), about = view.option.cells;
      if (!place) return "";
      return "<div>" + cellWords(view, place).map(page.escapeText).join("<br>") + "</div>" + '<div class="tip-row">' + page.escapeText(endOf(about, reference.case, place)[0]) + "</div>" +
        (reference.other && reference.other !== reference.case ? '<div class="fine">the other: ' + page.escapeText(endOf(about, reference.other, place)[0]) + "</div>" : "") + '<div class="fine">click: its command</div>';
    };
  }

  // ---- the orbit under a click --------------------------------------------------------------------------------------
  function pick(chart, view, option, hidden, at, pointsOnly) {
    const grids = [].concat(option.grid), grid = grids.findIndex((g, k) => chart.containPixel({ gridIndex: k }, at));
    if (grid < 0) return null;
    if (view.option.cells) return cellAt(view, chart, at);
    let best = null, nearest = pointsOnly ? 7 : 14;
    view.sources.forEach((source) => {
      if (!source.orbits || source.grid !== grid || source.tags.some((tag) => hidden.has(tag))) return;
      const axes = { xAxisIndex: source.grid, yAxisIndex: source.axis };
      if (source.reference.sweep === "cells") {
        if (pointsOnly) return;
        const value = chart.convertFromPixel(axes, at), k = source.rows.findIndex((r) => r[0] <= value[0] && value[0] <= r[1] && r[2] === Math.round(value[1]));
        if (k >= 0) best = { id: source.ids[k], orbit: source.orbits[k] };
        return;
      }
      if (!source.orbits.length) return;
      // Both scales are straight in what they show: two points give them.
      const axis = option.xAxis[grid], log = axis.type === "log", bend = log ? Math.log : (v) => v;
      const left = chart.convertToPixel({ xAxisIndex: axes.xAxisIndex }, axis.min), right = chart.convertToPixel({ xAxisIndex: axes.xAxisIndex }, axis.max);
      const zero = chart.convertToPixel({ yAxisIndex: axes.yAxisIndex }, 0), unit = chart.convertToPixel({ yAxisIndex: axes.yAxisIndex }, 1) - zero;
      const scale = (right - left) / (bend(axis.max) - bend(axis.min)), base = bend(axis.min), middle = base + (at[0] - left) / scale, reach = Math.abs(nearest / scale);
      const low = log ? Math.exp(middle - reach) : middle - reach, high = log ? Math.exp(middle + reach) : middle + reach;
      const values = source.values || source.rows.flatMap((row) => row.value);
      for (let i = 0; i < values.length; i += 2) {
        const x = values[i];
        if (!(x >= low && x <= high)) continue;
        const away = Math.hypot(left + (bend(x) - base) * scale - at[0], zero + values[i + 1] * unit - at[1]);
        if (away < nearest) { nearest = away; best = { id: source.reference.case, orbit: source.orbits[i >> 1], value: source.reference.sweep === "points" ? values[i + 1] : undefined }; }
      }
    });
    return best;
  }

  // ---- the side panel -----------------------------------------------------------------------------------------------
  let panel = null, charts = [], shown = null;
  function folder(study) {
    if (location.protocol !== "file:") return "results/" + study;
    return decodeURIComponent(location.pathname).replace(/\/[^/]*$/, "") || "/";
  }
  const quoted = (text) => (/^[\w./+-]+$/.test(text) ? text : "'" + text.replace(/'/g, "'\\''") + "'");
  function command(id, o) {
    const one = orbitsOf(id);
    return "ricochet point " + quoted(folder(data.study)) + " " + quoted(id) + " --parameter " + one.columns.parameter[o] + " --start " + quoted(String(cell(one, "start", o)));
  }
  function slice(id, table, names, o) {
    const orbit = block(id, table + "/orbit"), out = [];
    if (!orbit) return out;
    const columns = names.map((name) => block(id, table + "/" + name));
    for (let i = 0; i < orbit.length; ++i) if (orbit[i] === o) out.push(columns.map((c) => c[i]));
    return out;
  }
  function neighbour(id, o, step) {
    const one = orbitsOf(id), start = cell(one, "start", o);
    const list = one.group.map((g, k) => k).filter((k) => one.columns.start[k] === start).sort((a, b) => one.columns.parameter[a] - one.columns.parameter[b]);
    return list[list.indexOf(o) + step];
  }
  const words = {
    class: "class", period: "period", symmetric: "symmetric under x → −x, t → t + T/2", impacts_per_period: "impacts per period", exponent_method: "exponents by", exponent_twin: "exponent by twin trajectories (1/s)",
    marginal: "set apart", attractor: "attractor", alpha_equivalent: "equivalent viscosity (s)", recurrence: "recurrence distance", contraction: "contraction per period", zero_one: "0–1 test", transient_periods: "periods before the section",
    settled: "settled", chatter: "chatter", sticking: "share of time in contact", evidence: "evidence", status: "status", reason: "reason",
  };
  function facts(one, o) {
    const out = [];
    for (const name of Object.keys(one.columns)) {
      const value = one.columns[name][o];
      if (value === null || value === "" || name === "parameter" || name === "start" || /_(low|high)$/.test(name)) continue;
      const exponent = /^exponent_(\d+)$/.exec(name);
      if (exponent) out.push(["exponent " + exponent[1], interval(one, name, o)]);
      else out.push([words[name] || name.replace(/_/g, " "), typeof value === "number" ? page.number(value, 8) : value === true ? "yes" : value === false ? "no" : String(value)]);
    }
    return out;
  }
  const element = (name, classes, text) => { const e = document.createElement(name); if (classes) e.className = classes; if (text !== undefined) e.textContent = text; return e; };
  function button(text, label, action) { const b = element("button", "", text); b.type = "button"; b.setAttribute("aria-label", label); b.addEventListener("click", action); return b; }
  function plot(x, y, series, equal) {
    const axis = (quantity, vertical) => ({ type: "value", scale: true, name: quantity, nameLocation: "middle", nameGap: vertical ? 48 : 24, splitNumber: 4, axisLine: { show: true, onZero: false, lineStyle: { color: "#9a9a9a" } },
      axisLabel: { fontSize: 10, color: "#333", hideOverlap: true, formatter: (v) => page.number(v) }, nameTextStyle: { fontSize: 11, color: "#333" }, splitLine: { lineStyle: { color: "#ececec" } } });
    const box = element("div", equal ? "portrait" : "in-time");
    panel.appendChild(box);
    const chart = echarts.init(box, null, { renderer: "canvas" });
    chart.setOption({ animation: false, backgroundColor: "#fff", grid: { left: 62, right: 14, top: 10, bottom: 38 }, tooltip: { trigger: "item", confine: true, formatter: (p) => page.escapeText(x) + " = " + page.number(p.value[0], 7) + "<br>" + page.escapeText(y) + " = " + page.number(p.value[1], 7) },
      dataZoom: [{ type: "inside", xAxisIndex: 0, filterMode: "none", zoomOnMouseWheel: "shift" }], xAxis: axis(x, false), yAxis: axis(y, true), series });
    charts.push(chart);
  }
  // An empty panel under a title; `keys` stand beside it.
  function openPanel(label, colour, words, keys) {
    close();
    panel = element("aside", "orbit");
    panel.setAttribute("aria-label", label);
    panel.tabIndex = -1;
    const head = element("div", "orbit-head"), title = element("h3", "", words), swatch = element("span", "swatch"), beside = element("span", "orbit-keys");
    swatch.style.background = colour;
    title.prepend(swatch);
    for (const key of keys) beside.appendChild(key);
    beside.appendChild(button("×", "close", close));
    head.append(title, beside);
    panel.appendChild(head);
    document.body.appendChild(panel);
  }
  function show(view, found) { found.column === undefined ? open(found.id, found.orbit) : openCell(view, found); }
  function openCell(view, place) {
    const about = view.option.cells, own = endOf(about, place.id, place), words = cellWords(view, place);
    openPanel("The chosen cell", own[1], words[0] + ", " + words[1], []);
    shown = place;
    for (const [id, name] of about.grids) {
      panel.appendChild(element("p", "fine", name + ": " + endOf(about, id, place)[0] + (id === place.id ? ". The same cell again:" : "")));
      if (id === place.id) panel.appendChild(element("pre", "", "ricochet point " + quoted(folder(about.study)) + " " + quoted(id) + " --cell=" + about.xs[place.column] + "," + about.ys[place.row]));
    }
  }
  function open(id, o) {
    const one = orbitsOf(id), colour = data.groups[one.group[o]][1];
    openPanel("The chosen orbit", colour, data.parameter[0] + " = " + one.columns.parameter[o] + unitText(data.parameter), [["‹", "previous value", -1], ["›", "next value", 1]].map(([text, label, step]) => {
      const next = neighbour(id, o, step), b = button(text, label, () => { open(id, next); panel.focus(); });
      b.disabled = next === undefined;
      return b;
    }));
    shown = { id, orbit: o };
    panel.appendChild(element("p", "fine", (one.label ? one.label + " · " : "") + "start " + cell(one, "start", o) + " · " + regime(one, o) + (one.partial ? " · partial: this case is still being worked on" : "")));
    const motion = slice(id, "portrait", ["u", "v", "t"], o), section = slice(id, "points", ["u", "v"], o);
    const line = { type: "line", symbol: "none", color: colour, lineStyle: { color: colour, width: 1.3 } }, dots = { type: "scatter", symbolSize: 5, z: 3, color: "#111", itemStyle: { color: "#111" }, data: section };
    if (motion.length || section.length) plot("tip displacement (m)", "tip velocity (m/s)", (motion.length ? [Object.assign({ data: motion.map((r) => [r[0], r[1]]) }, line)] : []).concat(section.length ? [dots] : []), true);
    if (motion.length) plot("time from the strobe (s)", "tip displacement (m)", [Object.assign({ data: motion.map((r) => [r[2], r[0]]) }, line)], false);
    else panel.appendChild(element("p", "fine", (section.length ? "Dots: the section. " : "") + "No portrait is stored for this value and start; the command below marches it again."));
    if (motion.length && section.length) panel.appendChild(element("p", "fine", "Dots: the section."));
    const list = element("dl", "glossary");
    for (const [name, value] of facts(one, o)) { list.appendChild(element("dt", "", name)); list.appendChild(element("dd", "", value)); }
    panel.appendChild(list);
    panel.appendChild(element("p", "fine", "The same point again:"));
    panel.appendChild(element("pre", "", command(id, o)));
  }
  function close() {
    charts.forEach((chart) => chart.dispose());
    charts = [];
    if (panel) panel.remove();
    panel = shown = null;
  }
  document.addEventListener("keydown", (event) => { if (event.key === "Escape") close(); });

  return { start, dress, hover, leave, tooltip, drawCell, drawImage, cellTooltip, pick, show, open, close, panel: () => panel, shown: () => shown, command, cases: () => (data ? data.cases : null) };
})();

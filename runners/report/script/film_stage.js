// Draws one instant of a motion between its stops: a beam across its axis, a bar along it, a mass on a line, nodes on their plane, points as bars. What it draws on is a canvas.
{
  // The motion of one case at its instants, in metres, seconds and newtons.
  class Snapshots {
    constructor(data, one) {
      const held = data.page.snapshots.cases[one.id], block = (name) => data.block(one.id + "/snapshots/" + name);
      this.supports = data.page.snapshots.supports ?? [{ x: 0, type: "clamped" }];
      Object.assign(this, { one, ...held, t: block("t"), clamp: block("clamp"), counts: block("u"), pushed: block("pushed"), forces: block("force") });
      this.largest = this.counts.reduce((most, count) => Math.max(most, Math.abs(count)), 0) * this.metres;
      this.strongest = this.forces.reduce((most, count) => Math.max(most, Math.abs(count)), 0) * this.newtons;
      this.mass = this.x.length === 1 && !this.names;
      this.length = this.x[this.x.length - 1];
      this.parts = this.y ? 2 : 1;
      this.shown = this.y ? this.mainPart() : 0;
    }
    get count() { return this.t.length; }
    part(k, place, c) { return this.metres * this.counts[(k * this.x.length + place) * this.parts + c]; }
    // Of nodes on a plane the displacement along one axis.
    at(k, place) { return this.part(k, place, this.shown); }
    // The axis along which nodes move most.
    mainPart() {
      const sums = [0, 0];
      this.counts.forEach((count, i) => { sums[i % 2] += count * count; });
      return sums[1] >= sums[0] ? 1 : 0;
    }
    // What is said of an instant.
    said(k, text) {
      if (!this.names) return "tip " + text(this.tip(k), 4) + " m";
      let place = 0, most = 0;
      for (let p = 0; p < this.x.length; ++p) {
        const size = this.y ? Math.hypot(this.part(k, p, 0), this.part(k, p, 1)) : Math.abs(this.at(k, p));
        if (size > most) [most, place] = [size, p];
      }
      return "most at " + this.names[place] + ", " + text(most, 4) + " m";
    }
    tip(k) { return this.at(k, this.x.length - 1); }
    // The instant nearest to a time.
    nearest(time) {
      let low = 0, high = this.count - 1;
      while (high - low > 1) { const middle = (low + high) >> 1; if (this.t[middle] <= time) low = middle; else high = middle; }
      return time - this.t[low] < this.t[high] - time ? low : high;
    }
    // Between two places: a straight line.
    between(k, x) {
      const last = this.x.length - 1;
      let right = 1;
      while (right < last && this.x[right] < x) ++right;
      if (last === 0 || x >= this.x[last]) return this.at(k, last);
      const share = (x - this.x[right - 1]) / (this.x[right] - this.x[right - 1]);
      return (1 - share) * this.at(k, right - 1) + share * this.at(k, right);
    }
    // Points that are pushed at an instant, {point, force}.
    contacts(k) {
      const m = this.point.length, out = [];
      let low = 0, high = this.pushed.length;
      while (low < high) { const middle = (low + high) >> 1; if (this.pushed[middle] < k * m) low = middle + 1; else high = middle; }
      for (let i = low; i < this.pushed.length && this.pushed[i] < (k + 1) * m; ++i) out.push({ point: this.pushed[i] - k * m, force: this.newtons * this.forces[i] });
      return out;
    }
  }

  const roomOf = (context) => { const { width, height } = context.canvas.getBoundingClientRect(); return { width, height }; };
  // A canvas as fine as the screen, empty, and its colours those of the page.
  function fresh(canvas) {
    const context = canvas.getContext("2d"), { width, height } = roomOf(context), fine = window.devicePixelRatio || 1;
    canvas.width = Math.max(1, Math.round(width * fine));
    canvas.height = Math.max(1, Math.round(height * fine));
    context.setTransform(fine, 0, 0, fine, 0, 0);
    context.font = "12px system-ui, sans-serif";
    return { context, width, height, ink: ricochet.theme.ink() };
  }

  // Nodes on their plane: one scale for places, one for displacements, by which the largest is a tenth of the structure.
  function planeScales(shots, box, largest) {
    const { x, y } = shots[0], room = 46, extent = (values) => Math.max(...values) - Math.min(...values), wide = extent(x), tall = extent(y);
    const along = Math.min((box.width - 2 * room) / (wide || 1e-300), (box.height - 2 * room) / (tall || 1e-300)), larger = 0.1 * Math.max(wide, tall) / largest;
    return { left: box.left + 0.5 * (box.width - along * wide), lowX: Math.min(...x), middle: box.top + 0.5 * (box.height + along * tall), lowY: Math.min(...y), along, across: along * larger, larger };
  }
  // How lengths become pixels in a box: `along` of positions, `across` of displacements.
  function scalesOf(shots, box) {
    const finite = shots.flatMap((one) => [...one.lower, ...one.upper]).filter((stop) => stop !== null), largest = Math.max(...shots.map((one) => one.largest), 1e-300);
    const reach = Math.max(largest, ...finite.map(Math.abs).filter((stop) => stop < 3 * largest)) * 1.15, length = Math.max(...shots.map((one) => one.length));
    if (shots[0].y) return planeScales(shots, box, largest);
    if (shots[0].names) return { left: box.left + 26, middle: box.top + 0.47 * box.height, along: (box.width - 52) / shots[0].x.length, across: 0.4 * box.height / reach };
    if (shots[0].mass) return { centre: box.left + 0.5 * box.width, across: 0.42 * box.width / reach };
    if (shots[0].along) { const across = 0.12 * length / largest, along = box.width / (1.35 * length); return { left: box.left + 0.13 * box.width, along, across: along * across, larger: across }; }
    const along = (box.width - 40) / length, across = 0.44 * box.height / reach;
    return { left: box.left + 26, middle: box.top + 0.5 * box.height, along, across, larger: across / along };
  }

  function stroke(context, colour, width, dash, path) {
    context.save();
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.setLineDash(dash);
    context.beginPath();
    path(context);
    context.stroke();
    context.restore();
  }
  function arrow(context, colour, [x, y], [dx, dy]) {
    const size = Math.hypot(dx, dy), [ex, ey] = [dx / size, dy / size], back = [x - dx, y - dy], wing = 5;
    stroke(context, colour, 2, [], (c) => {
      c.moveTo(...back); c.lineTo(x, y);
      c.moveTo(x - wing * (ex + 0.6 * ey), y - wing * (ey - 0.6 * ex)); c.lineTo(x, y); c.lineTo(x - wing * (ex - 0.6 * ey), y - wing * (ey + 0.6 * ex));
    });
  }
  // A stop: a line with hatches on the side that nothing enters.
  function stop(context, ink, from, to, [nx, ny]) {
    stroke(context, ink, 1.4, [], (c) => {
      c.moveTo(...from); c.lineTo(...to);
      const length = Math.hypot(to[0] - from[0], to[1] - from[1]), hatches = Math.max(2, Math.round(length / 6));
      for (let k = 0; k <= hatches; ++k) {
        const x = from[0] + k / hatches * (to[0] - from[0]), y = from[1] + k / hatches * (to[1] - from[1]);
        c.moveTo(x, y); c.lineTo(x + 5 * nx - (nx ? 0 : 2), y + 5 * ny + (nx ? 3 : 0));
      }
    });
  }
  // What holds a beam at (x, y): a block beside a clamp, a triangle under a pin, plates beside a guide, coils under a spring.
  function support(context, ink, type, x, y, side) {
    context.fillStyle = ink;
    if (type === "clamped") context.fillRect(side < 0 ? x - 10 : x, y - 14, 10, 28);
    else stroke(context, ink, 1.4, [], (c) => {
      if (type === "sliding") for (const away of [2, 8]) { c.moveTo(x + side * away, y - 12); c.lineTo(x + side * away, y + 12); }
      else if (type === "pinned") { c.moveTo(x, y); c.lineTo(x - 7, y + 12); c.lineTo(x + 7, y + 12); c.closePath(); }
      else { c.moveTo(x, y); for (let n = 0; n < 6; ++n) c.lineTo(x + (n % 2 ? -5 : 5), y + 4 + 3 * n); c.lineTo(x, y + 24); }
    });
  }
  const arrowLength = (force, strongest) => 12 + 42 * Math.abs(force) / strongest;

  // Each draws {shots, k, colour, dash} with scales into a box.
  const drawers = {
    beam(context, { shots, k, colour, dash }, { left, middle, along, across }, box, strongest, ink) {
      const px = (x) => left + along * x, py = (u) => middle - across * u, half = Math.min(9, 0.5 * along * shots.length / Math.max(1, shots.point.length));
      for (const [stops, side] of [[shots.lower, 1], [shots.upper, -1]])
        stops.forEach((u, p) => { if (u !== null) stop(context, ink, [px(shots.point[p]) - half, py(u)], [px(shots.point[p]) + half, py(u)], [0, side]); });
      for (const { x, type } of shots.supports) support(context, ink, type, px(x), py(shots.clamp[k]), x < 0.5 * shots.length ? -1 : 1);
      stroke(context, colour, 3, dash, (c) => shots.x.forEach((x, place) => c.lineTo(px(x), py(shots.at(k, place)))));
      for (const { point, force } of shots.contacts(k)) {
        const x = shots.point[point];
        arrow(context, colour, [px(x), py(shots.between(k, x)) + 3 * Math.sign(force)], [0, -Math.sign(force) * arrowLength(force, strongest)]);
      }
    },
    bar(context, { shots, k, colour, dash, row }, { left, along, across }, box, strongest, ink) {
      const y = box.top + box.height * (0.35 + 0.3 * row), px = (x, u) => left + along * x + across * u, high = 14;
      shots.point.forEach((x, p) => {
        for (const [u, side] of [[shots.lower[p], -1], [shots.upper[p], 1]]) if (u !== null) stop(context, ink, [px(x, u), y - high - 4], [px(x, u), y + high + 4], [side, 0]);
      });
      stroke(context, colour, 1.6, dash, (c) => {
        shots.x.forEach((x, place) => { const at = px(x, shots.at(k, place)); c.moveTo(at, y - high); c.lineTo(at, y + high); });
        for (const edge of [-high, high]) { c.moveTo(px(0, shots.at(k, 0)), y + edge); c.lineTo(px(shots.length, shots.tip(k)), y + edge); }
      });
      for (const { point, force } of shots.contacts(k)) arrow(context, colour, [px(shots.point[point], shots.between(k, shots.point[point])), y], [Math.sign(force) * arrowLength(force, strongest), 0]);
    },
    // Nodes where they are, with displacements made larger; a stop stands where its node would touch it.
    plane(context, { shots, k, colour, dash }, { left, lowX, middle, lowY, along, across }, box, strongest, ink) {
      const px = (p) => left + along * (shots.x[p] - lowX) + across * shots.part(k, p, 0), py = (p) => middle - along * (shots.y[p] - lowY) - across * shots.part(k, p, 1);
      const rest = (p) => [left + along * (shots.x[p] - lowX), middle - along * (shots.y[p] - lowY)], half = 9;
      stroke(context, ink, 0.6, [2, 3], (c) => { for (const [a, b] of shots.links) { c.moveTo(...rest(a)); c.lineTo(...rest(b)); } });
      stroke(context, colour, 2.4, dash, (c) => {
        for (const [a, b] of shots.links) { c.moveTo(px(a), py(a)); c.lineTo(px(b), py(b)); }
        if (!shots.links.length) shots.x.forEach((_, p) => { c.moveTo(px(p) + 2, py(p)); c.arc(px(p), py(p), 2, 0, 7); });
      });
      context.fillStyle = ink;
      for (const p of shots.held) context.fillRect(px(p) - 4, py(p) - 4, 8, 8);
      shots.stops.forEach(({ at, to, direction: [dx, dy] }, i) => {
        const size = Math.hypot(dx, dy);
        if (at < 0 || size < 0.2) return;
        const [ex, ey] = [dx / size, -dy / size], [x, y] = rest(at), moved = to < 0 ? 0 : across * (shots.part(k, to, 0) * dx + shots.part(k, to, 1) * dy) / size;
        for (const [bound, side] of [[shots.lower[i], -1], [shots.upper[i], 1]]) {
          if (bound === null) continue;
          const far = across * bound + moved, fx = x + far * ex, fy = y + far * ey;
          stop(context, ink, [fx - half * ey, fy + half * ex], [fx + half * ey, fy - half * ex], [side * ex, side * ey]);
        }
      });
      for (const { point, force } of shots.contacts(k)) {
        const { at, direction: [dx, dy] } = shots.stops[point], size = Math.hypot(dx, dy), long = Math.sign(force) * arrowLength(force, strongest);
        if (at >= 0 && size >= 0.2) arrow(context, colour, [px(at), py(at)], [long * dx / size, -long * dy / size]);
      }
    },
    // Points without places: what each is displaced by, beside its stops.
    points(context, { shots, k, colour, dash, row }, { left, middle, along, across }, box, strongest, ink) {
      const px = (p) => left + along * (p + 0.5) + (row === 0.5 ? 0 : 8 * (row - 0.5)), py = (u) => middle - across * u, half = Math.min(14, 0.35 * along);
      stroke(context, ink, 0.6, [], (c) => { c.moveTo(left, middle); c.lineTo(left + along * shots.x.length, middle); });
      shots.stops.forEach(({ at }, i) => {
        for (const [u, side] of [[shots.lower[i], 1], [shots.upper[i], -1]]) if (u !== null && at >= 0) stop(context, ink, [px(at) - half, py(u)], [px(at) + half, py(u)], [0, side]);
      });
      shots.x.forEach((_, p) => stroke(context, colour, 5, dash.length ? [3, 2] : [], (c) => { c.moveTo(px(p), middle); c.lineTo(px(p), py(shots.at(k, p))); }));
      context.fillStyle = ink;
      context.textBaseline = "bottom";
      context.textAlign = "center";
      shots.names.forEach((name, p) => context.fillText(name, left + along * (p + 0.5), box.top + box.height - 2, along));
      context.textAlign = "start";
      for (const { point, force } of shots.contacts(k)) {
        const { at } = shots.stops[point];
        if (at >= 0) arrow(context, colour, [px(at) + 9, py(shots.at(k, at))], [0, -Math.sign(force) * arrowLength(force, strongest)]);
      }
    },
    mass(context, { shots, k, colour, dash, row }, { centre, across }, box, strongest, ink) {
      const y = box.top + box.height * (0.35 + 0.3 * row), px = (u) => centre + across * u, half = 11, u = shots.at(k, 0), wall = box.left + 6;
      for (const [at, side] of [[shots.lower[0], -1], [shots.upper[0], 1]])
        if (at !== null && at !== undefined) stop(context, ink, [px(at) + side * half, y - 26], [px(at) + side * half, y + 26], [side, 0]);
      stroke(context, ink, 1.2, [], (c) => {
        const coils = 12, from = wall, to = px(u) - half;
        c.moveTo(from, y);
        for (let n = 1; n < coils; ++n) c.lineTo(from + n / coils * (to - from), y + (n % 2 ? -6 : 6));
        c.lineTo(to, y);
      });
      stroke(context, colour, 2.4, dash, (c) => c.rect(px(u) - half, y - half, 2 * half, 2 * half));
      for (const { force } of shots.contacts(k)) arrow(context, colour, [px(u) - Math.sign(force) * half, y], [Math.sign(force) * arrowLength(force, strongest), 0]);
    },
  };

  // Draws films [{shots, k, colour, dash, name}] over each other or side by side; returns what is to be said of the scale.
  function drawStage(canvas, films, overlay) {
    const { context, width, height, ink } = fresh(canvas), all = films.map((film) => film.shots), beside = !overlay && films.length > 1;
    const boxes = films.map((_, f) => (beside ? { left: f * width / films.length, top: 22, width: width / films.length, height: height - 26 } : { left: 0, top: 22, width, height: height - 26 }));
    const strongest = Math.max(...all.map((one) => one.strongest), 1e-300), draw = all[0].y ? drawers.plane : all[0].names ? drawers.points : all[0].mass ? drawers.mass : all[0].along ? drawers.bar : drawers.beam;
    let scales = null;
    context.clearRect(0, 0, width, height);
    films.forEach((film, f) => {
      scales = scalesOf(all, boxes[f]);
      context.fillStyle = film.colour;
      context.textBaseline = "top";
      context.fillText(film.name, beside ? boxes[f].left + 4 : 4 + f * width / films.length, 4, width / films.length - 8);
      draw(context, { ...film, row: beside ? 0.5 : films.length > 1 ? f : 0.5 }, scales, boxes[f], strongest, ink);
    });
    const { text, shown } = ricochet.format, arrows = strongest > 1e-299 ? " The longest arrow is a force of " + text(strongest, 3) + " N." : "";
    return (scales.larger === undefined ? "" : "Displacements are drawn " + shown(scales.larger, 2) + " times as large as lengths.") + arrows;
  }

  Object.assign(ricochet, { Snapshots, drawStage, freshCanvas: fresh });
}

// Draws one instant of a motion between its stops on a canvas. A beam moves across its axis, a bar along it, a mass on
// a line. Nodes move on their plane; points without a place are bars.
{
  const roomOf = (context) => {
    const {width, height} = context.canvas.getBoundingClientRect();
    return {width, height};
  };
  // A canvas as fine as the screen, empty, and its colours those of the page.
  function fresh(canvas) {
    const context = canvas.getContext("2d"), {width, height} = roomOf(context), fine = window.devicePixelRatio || 1;
    canvas.width = Math.max(1, Math.round(width * fine));
    canvas.height = Math.max(1, Math.round(height * fine));
    context.setTransform(fine, 0, 0, fine, 0, 0);
    context.font = "12px system-ui, sans-serif";
    return {context, width, height, ink: ricochet.theme.ink()};
  }

  // Where a structure is drawn in a box. `rest`: where a place is at rest, pixels. `axes`: pixels of a metre of each
  // displacement. `larger`: how many times displacements are larger than lengths. `half`: half the side of a mass,
  // pixels.
  function geometryOf(shots, box, row) {
    const [{x, y, names, mass, along: bar, oblique}] = shots,
                                           largest = Math.max(...shots.map((one) => one.largest), 1e-300);
    const finite = shots.flatMap((one) => [...one.lower, ...one.upper])
                       .filter((stop) => stop !== null)
                       .map(Math.abs)
                       .filter((stop) => stop < 3 * largest),
          reach = Math.max(largest, ...finite);
    const extent = (values) => Math.max(...values) - Math.min(...values), middle = box.top + 0.5 * box.height,
          length = Math.max(...shots.map((one) => one.length)), rowY = box.top + box.height * (0.35 + 0.3 * row);
    if (y) {
      const wide = extent(x), tall = extent(y), room = 60,
            along = Math.min((box.width - 2 * room) / (wide || 1e-300), (box.height - 2 * room) / (tall || 1e-300)),
            larger = (tall ? 0.1 * Math.max(wide, tall) : 0.42 * box.height / along) / reach;
      const across = along * larger, left = box.left + 0.5 * (box.width - along * wide) - along * Math.min(...x),
            low = middle + 0.5 * along * tall + along * Math.min(...y);
      return {
        rest: (p) => [left + along * x[p], low - along * y[p]],
        axes: [oblique ? [-0.62 * across, 0.46 * across] : [across, 0], [0, -across]],
        larger
      };
    }
    if (names) {
      const along = (box.width - 52) / x.length, across = 0.36 * box.height / reach,
            aside = row === 0.5 ? 0 : 8 * (row - 0.5);
      return {
        rest: (p) => [box.left + 26 + along * (p + 0.5) + aside, box.top + 0.47 * box.height],
        axes: [[0, -across]]
      };
    }
    if (mass) return {rest: () => [box.left + 0.5 * box.width, rowY], axes: [[0.36 * box.width / reach, 0]], half: 11};
    if (bar) {
      const larger = 0.12 * length / largest, along = box.width / (1.35 * length);
      return {rest: (p) => [box.left + 0.13 * box.width + along * x[p], rowY], axes: [[along * larger, 0]], larger};
    }
    const along = (box.width - 60) / length, across = 0.4 * box.height / reach;
    return {rest: (p) => [box.left + 36 + along * x[p], middle], axes: [[0, -across]], larger: across / along};
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
      c.moveTo(...back);
      c.lineTo(x, y);
      c.moveTo(x - wing * (ex + 0.6 * ey), y - wing * (ey - 0.6 * ex));
      c.lineTo(x, y);
      c.lineTo(x - wing * (ex - 0.6 * ey), y - wing * (ey + 0.6 * ex));
    });
  }
  // A stop: a line with hatches on the side that nothing enters.
  function stop(context, ink, from, to, [nx, ny]) {
    stroke(context, ink, 1.4, [], (c) => {
      c.moveTo(...from);
      c.lineTo(...to);
      const length = Math.hypot(to[0] - from[0], to[1] - from[1]), hatches = Math.max(2, Math.round(length / 6));
      for (let k = 0; k <= hatches; ++k) {
        const x = from[0] + k / hatches * (to[0] - from[0]), y = from[1] + k / hatches * (to[1] - from[1]);
        c.moveTo(x, y);
        c.lineTo(x + 5 * nx - (nx ? 0 : 2), y + 5 * ny + (nx ? 3 : 0));
      }
    });
  }
  // What holds a beam at (x, y): a block beside a clamp, a triangle under a pin, plates beside a guide, coils under a
  // spring.
  function support(context, ink, type, x, y, side) {
    context.fillStyle = ink;
    if (type === "clamped") context.fillRect(side < 0 ? x - 10 : x, y - 14, 10, 28);
    else
      stroke(context, ink, 1.4, [], (c) => {
        if (type === "sliding")
          for (const away of [2, 8]) {
            c.moveTo(x + side * away, y - 12);
            c.lineTo(x + side * away, y + 12);
          }
        else if (type === "pinned") {
          c.moveTo(x, y);
          c.lineTo(x - 7, y + 12);
          c.lineTo(x + 7, y + 12);
          c.closePath();
        } else {
          c.moveTo(x, y);
          for (let n = 0; n < 6; ++n) c.lineTo(x + (n % 2 ? -5 : 5), y + 4 + 3 * n);
          c.lineTo(x, y + 24);
        }
      });
  }
  const arrowLength = (force, strongest) => 12 + 42 * Math.abs(force) / strongest;

  const between = (f, p) => {
    const q = Math.floor(p), share = p - q, a = f(q);
    if (!share) return a;
    const b = f(q + 1);
    return a.map((value, i) => (1 - share) * value + share * b[i]);
  };

  // One case at an instant: stops behind, what moves over them, forces in front.
  class Stage {
    constructor(context, film, geometry, ink, taken) {
      Object.assign(this, {context, ...film, ...geometry, ink, taken});
    }
    rested(p) { return between(this.rest, p); }
    shift(p) {
      const {shots, k, axes} = this;
      return axes.reduce(([x, y], [ax, ay], c) => {
        const u = shots.part(k, p, c);
        return [x + ax * u, y + ay * u];
      }, [0, 0]);
    }
    moved(p) {
      const [x, y] = this.rested(p), [dx, dy] = this.shift(p);
      return [x + dx, y + dy];
    }
    // Pixels of a metre along what a stop bounds.
    towards(direction) {
      return this.axes.reduce(([x, y], [ax, ay], c) => [x + ax * direction[c], y + ay * direction[c]], [0, 0]);
    }
    // A text that covers no other; none where there is no room.
    label(x, y, words) {
      const {context, taken} = this;
      if (!words || !taken) return;
      const wide = context.measureText(words).width,
            free = (top) =>
                taken.every(([l, r, t]) => x + 0.5 * wide < l || x - 0.5 * wide > r || Math.abs(top - t) > 12);
      const top = [0, -13, 13, -26, 26].map((more) => y + more).find(free);
      if (top === undefined) return;
      taken.push([x - 0.5 * wide, x + 0.5 * wide, top]);
      context.textAlign = "center";
      context.textBaseline = "middle";
      context.fillStyle = this.ink;
      context.fillText(words, x, top);
      context.textAlign = "start";
    }
    stops() {
      const {context, ink, shots, k} = this, reach = Math.min(9, 200 / Math.max(1, shots.stops.length)),
                                  {text} = ricochet.format,
                                  named = shots.stops.length <= 12 ||
          shots.stops.some((one, i) => i && one.name === shots.stops[i - 1].name);
      let ringed = "";
      shots.stops.forEach(({at, to, direction, name}, i) => {
        if (at < 0) return;
        const rest = this.rested(at), away = to < 0 ? 0 : shots.bounded(k, to, direction),
              [tx, ty] = this.towards(direction), size = Math.hypot(tx, ty),
              sides = shots.stops.filter((one) => one.name === name && one.at === at).length;
        if (shots.y && sides > 2 && name) {  // the sides of a clearance
          if (ringed === name) return;
          ringed = name;
          const [bx, by] = to < 0 ? [0, 0] : this.shift(to), radius = shots.upper[i] ?? -shots.lower[i],
                     point = (turn) => this.towards([radius * Math.sin(turn), radius * Math.cos(turn)]);
          stroke(context, ink, 1.4, [], (c) => {
            for (let n = 0; n <= 48; ++n) {
              const [x, y] = point(n / 24 * Math.PI);
              c.lineTo(rest[0] + bx + x, rest[1] + by + y);
            }
          });
          const [, up] = point(0);
          return this.label(rest[0] + bx, rest[1] + by + up - 12, name + " " + text(radius, 3) + " m");
        }
        if (size < 0.2 * Math.hypot(...this.axes[0])) return;
        const [ex, ey] = [tx / size, ty / size];
        let words = named ? name : "";
        for (const [bound, side] of [[shots.upper[i], 1], [shots.lower[i], -1]]) {
          if (bound === null || bound === undefined) continue;
          const far = (bound + away) * size + side * (this.half ?? 0), x = rest[0] + far * ex, y = rest[1] + far * ey,
                half = shots.mass || shots.along ? 20 : reach;
          stop(context, ink, [x - half * ey, y + half * ex], [x + half * ey, y - half * ex], [side * ex, side * ey]);
          if (to >= 0)
            stroke(context, ink, 0.8, [3, 3], (c) => {
              c.moveTo(x, y);
              c.lineTo(...this.moved(to));
            });
          if (named && name)
            this.label(
                x + side * 14 * ex, Math.abs(ex) > Math.abs(ey) ? y - half - 14 : y + side * 15 * ey,
                (words + " " + text(bound, 3) + " m").trim());
          words = "";
        }
      });
    }
    // What holds it, and what it is.
    shape() {
      const {context, ink, shots, k, colour, dash} = this,
                                             line = (c, places) => places.forEach(
                                                 (p, n) =>
                                                     (n ? c.lineTo(...this.moved(p)) : c.moveTo(...this.moved(p)))),
                                             all = shots.x.map((_, p) => p);
      if (shots.y) {
        const joined = new Set(shots.links.flat()),
              inLine = !shots.oblique && shots.bodies && shots.y.every((y) => y === shots.y[0]);
        stroke(context, ink, 0.6, [2, 3], (c) => {
          for (const [a, b] of shots.links) {
            c.moveTo(...this.rested(a));
            c.lineTo(...this.rested(b));
          }
        });
        stroke(context, colour, 2.4, dash, (c) => {
          for (const link of shots.links) line(c, link);
          // What moves along its line shows by its nodes.
          if (inLine)
            for (const p of all) {
              const [x, y] = this.moved(p);
              c.moveTo(x, y - 9);
              c.lineTo(x, y + 9);
            }
          for (const p of all)
            if (!joined.has(p)) {
              const [x, y] = this.moved(p);
              c.rect(x - 6, y - 6, 12, 12);
            }
        });
        context.fillStyle = ink;
        for (const p of shots.held) {
          const [x, y] = this.moved(p);
          context.fillRect(x - 4, y - 4, 8, 8);
        }
        for (const {name, first} of shots.bodies ?? []) {
          const [x, y] = this.rested(first);
          this.label(x + (inLine ? 0.5 : -0.5) * (context.measureText(name).width + 16), inLine ? y + 24 : y, name);
        }
      } else if (shots.names) {
        const [[left, y], [right]] = [this.rest(-0.5), this.rest(shots.x.length - 0.5)];
        stroke(context, ink, 0.6, [], (c) => {
          c.moveTo(left, y);
          c.lineTo(right, y);
        });
        for (const p of all)
          stroke(context, colour, 5, dash.length ? [3, 2] : [], (c) => {
            c.moveTo(...this.rest(p));
            c.lineTo(...this.moved(p));
          });
        for (const p of all) this.label(this.rest(p)[0], this.box.top + this.box.height - 8, shots.names[p]);
      } else if (shots.mass) {
        const [x, y] = this.moved(0), half = this.half, coils = 12, from = this.box.left + 6, to = x - half;
        stroke(context, ink, 1.2, [], (c) => {
          c.moveTo(from, y);
          for (let n = 1; n < coils; ++n) c.lineTo(from + n / coils * (to - from), y + (n % 2 ? -6 : 6));
          c.lineTo(to, y);
        });
        stroke(context, colour, 2.4, dash, (c) => c.rect(x - half, y - half, 2 * half, 2 * half));
      } else if (shots.along) {
        const high = 14;
        stroke(context, colour, 1.6, dash, (c) => {
          for (const p of all) {
            const [x, y] = this.moved(p);
            c.moveTo(x, y - high);
            c.lineTo(x, y + high);
          }
          for (const edge of [-high, high])
            for (const p of [0, all.length - 1]) {
              const [x, y] = this.moved(p);
              if (p) c.lineTo(x, y + edge);
              else c.moveTo(x, y + edge);
            }
        });
      } else {
        for (const {x, type} of shots.supports) {
          const [px, py] = this.rested(x / shots.length * (all.length - 1)), [, up] = this.towards([shots.clamp[k]]);
          support(context, ink, type, px, py + up, x < 0.5 * shots.length ? -1 : 1);
        }
        stroke(context, colour, 3, dash, (c) => line(c, all));
      }
    }
    forces(strongest) {
      const {context, shots, k, colour} = this;
      for (const {point, force} of shots.contacts(k)) {
        const {at, direction} = shots.stops[point], [tx, ty] = this.towards(direction), size = Math.hypot(tx, ty);
        if (at < 0 || !(size > 0)) continue;
        const long = Math.sign(force) * arrowLength(force, strongest) / size, [x, y] = this.moved(at),
              off = this.half ?? 0;
        arrow(
            context, colour, [x - Math.sign(force) * off * tx / size, y - Math.sign(force) * off * ty / size],
            [long * tx, long * ty]);
      }
    }
  }

  // Draws films [{shots, k, colour, dash, name}] over each other or side by side; returns what is to be said of the
  // scale.
  function drawStage(canvas, films, overlay) {
    const {context, width, height, ink} = fresh(canvas), all = films.map((film) => film.shots),
                                   beside = !overlay && films.length > 1;
    const boxes = films.map(
        (_, f) =>
            (beside ? {left: f * width / films.length, top: 22, width: width / films.length, height: height - 26} :
                      {left: 0, top: 22, width, height: height - 26}));
    const strongest = Math.max(...all.map((one) => one.strongest), 1e-300);
    let geometry = null;
    const taken = [];
    context.clearRect(0, 0, width, height);
    films.forEach((film, f) => {
      const row = beside || films.length < 2 ? 0.5 : f;
      geometry = {...geometryOf(all, boxes[f], row), box: boxes[f]};
      context.fillStyle = film.colour;
      context.textBaseline = "top";
      context.fillText(
          film.name, beside ? boxes[f].left + 4 : 4 + f * width / films.length, 4, width / films.length - 8);
      const stage = new Stage(context, film, geometry, ink, beside || !f ? taken : null);
      stage.stops();
      stage.shape();
      stage.forces(strongest);
    });
    const {text, shown} = ricochet.format,
                 arrows = strongest > 1e-299 ? " The longest arrow is a force of " + text(strongest, 3) + " N." : "";
    return (geometry.larger === undefined ?
                "" :
                "Displacements are drawn " + shown(geometry.larger, 2) + " times as large as lengths.") +
        arrows;
  }

  Object.assign(ricochet, {drawStage, freshCanvas: fresh});
}

{
  // The motion of one case at its instants, in metres, seconds and newtons.
  class Snapshots {
    constructor(data, one) {
      const held = data.page.snapshots.cases[one.id], block = (name) => data.block(one.id + "/snapshots/" + name);
      this.supports = data.page.snapshots.supports ?? [{x: 0, type: "clamped"}];
      Object.assign(this, {
        one,
        ...held,
        t: block("t"),
        clamp: block("clamp"),
        counts: block("u"),
        pushed: block("pushed"),
        forces: block("force")
      });
      this.largest = this.counts.reduce((most, count) => Math.max(most, Math.abs(count)), 0) * this.metres;
      this.strongest = this.forces.reduce((most, count) => Math.max(most, Math.abs(count)), 0) * this.newtons;
      this.parts = this.y ? 2 : 1;
      this.oblique = this.y && this.axes[0] === "z";
      this.mass = this.x.length === 1 && !this.names;
      this.length = this.x[this.x.length - 1];
      this.shown = this.y ? this.mainPart() : 0;
      if (!this.stops.length)
        this.stops =
            this.point.map((x) => ({at: this.length ? x / this.length * (this.x.length - 1) : 0, to: -1, name: ""}));
      if (!this.y)
        for (const stop of this.stops) stop.direction = [1, 0];
    }
    get count() { return this.t.length; }
    // Between two places: a straight line.
    part(k, place, c) {
      const p = Math.floor(place), share = place - p,
            at = (q) => this.metres * this.counts[(k * this.x.length + q) * this.parts + c];
      return share ? (1 - share) * at(p) + share * at(p + 1) : at(p);
    }
    // Of nodes on a plane the displacement along one axis.
    at(k, place) { return this.part(k, place, this.shown); }
    // What a stop bounds of a place.
    bounded(k, place, direction) {
      return this.part(k, place, 0) * direction[0] + (this.y ? this.part(k, place, 1) * direction[1] : 0);
    }
    // The axis along which nodes move most.
    mainPart() {
      const sums = [0, 0];
      this.counts.forEach((count, i) => {
        sums[i % 2] += count * count;
      });
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
      while (high - low > 1) {
        const middle = (low + high) >> 1;
        if (this.t[middle] <= time) low = middle;
        else high = middle;
      }
      return time - this.t[low] < this.t[high] - time ? low : high;
    }
    // Points that are pushed at an instant, {point, force}.
    contacts(k) {
      const m = this.point.length, out = [];
      let low = 0, high = this.pushed.length;
      while (low < high) {
        const middle = (low + high) >> 1;
        if (this.pushed[middle] < k * m) low = middle + 1;
        else high = middle;
      }
      for (let i = low; i < this.pushed.length && this.pushed[i] < (k + 1) * m; ++i)
        out.push({point: this.pushed[i] - k * m, force: this.newtons * this.forces[i]});
      return out;
    }
  }

  ricochet.Snapshots = Snapshots;
}

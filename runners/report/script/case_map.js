// A figure of more charts than a page can show, as a map of its cases. It has a row per method, and columns along what
// the figure is about. A cell's colour is what the figure shows; a mark says that a case has no result. Below stand the
// smallest and the largest. The charts of a row are drawn when it is chosen.
//
// What a figure says for this, beside its charts: `measured` {key, along, values}. Figures of one key share a map.
// `along` is the column of the cases that it is about; `values` are {view, quantity, of}, `of` a number of a case or
// null. Its charts name their `cases`.
{
  const {numberOf, textOf, roleOf, isMethod, Interval} = ricochet, {escape, text, unit, mark, count} = ricochet.format;
  const mostCharts = 24, mostRows = 60, mostEmpty = 2, mostColumns = 96, mostCells = 4000, mostWritten = 12,
        listed = 10, aroundMap = 135;
  // Pale to dark, so that the order shows without colours too.
  const ramp = ["#F6F2DC", "#D3E6C4", "#93CBB5", "#4EA3B6", "#2C6FA3", "#22366F"];

  const channels = (colour) => [1, 3, 5].map((k) => parseInt(colour.slice(k, k + 2), 16));
  function colourAt(share) {
    const at = Math.min(Math.max(share, 0), 1) * (ramp.length - 1), k = Math.min(Math.floor(at), ramp.length - 2),
          from = channels(ramp[k]), to = channels(ramp[k + 1]);
    return from.map((value, c) => Math.round(value + (at - k) * (to[c] - value)));
  }

  // Which columns of the cases become rows of the map and which columns. What is no method joins the columns, longest
  // first, until the rows fit a screen. Numbers of methods follow.
  function layout(view, cases, along) {
    const many = (columns) => view.group(cases, columns).length,
          numeric = view.varying.filter((column) => cases.some((one) => numberOf(one, column) !== null));
    const longest = (columns) => columns.slice().sort((a, b) => many([b]) - many([a]));
    const [first] = [along, "step"].filter((column) => view.varies(column)).concat(longest(numeric), view.varying);
    let columns = first === undefined ? [] : [first], rows = view.varying.filter((column) => column !== first);
    const movable = longest(rows.filter((column) => !isMethod(column)))
                        .concat(longest(rows.filter((column) => isMethod(column) && numeric.includes(column))));
    for (const column of movable) {
      if (many(rows) <= mostRows) break;
      if (many([column, ...columns]) > mostColumns) continue;
      // A parameter of a few methods would leave most of its columns empty to all others.
      if (many([column, ...columns]) * many(rows.filter((other) => other !== column)) > mostEmpty * cases.length)
        continue;
      columns = [column, ...columns];
      rows = rows.filter((other) => other !== column);
    }
    return {columns, rows};
  }
  // Groups in the order of the values of their columns: numbers by size, words as they appear.
  function ordered(view, cases, columns) {
    const place = (one, column) => {
      const number = numberOf(one, column);
      return textOf(one, column) === "" ? -Infinity :
          number === null               ? view.values(column).indexOf(textOf(one, column)) :
                                          number;
    };
    const compare = ({cases: [a]}, {cases: [b]}) =>
        columns.reduce((found, column) => found || Math.sign(place(a, column) - place(b, column)) || 0, 0);
    return view.group(cases, columns).sort(compare);
  }
  // Cells of headers that span what they share: a list per level, of {label, title, span}.
  function headers(view, groups, levels) {
    const out = levels.map(() => []);
    groups.forEach(({cases: [one]}, g) => {
      let fresh = g === 0;
      levels.forEach((columns, level) => {
        const label = columns.map((column) => textOf(one, column)).join("\u001f");
        fresh = fresh || label !== out[level][out[level].length - 1].key;
        if (fresh) out[level].push({key: label, at: g, span: 1, one, columns});
        else ++out[level][out[level].length - 1].span;
      });
    });
    return out;
  }

  class CaseMap extends ricochet.Figure {
    constructor(description, section) {
      super(description, section);
      const {view, cases} = description.map;
      Object.assign(this, {data: view, cases});
      this.body = document.createElement("div");
      this.body.className = "waits";
      section.classList.add("mapped");
      this.chosen = document.createElement("div");
      section.append(this.body, this.chosen);
      this.body.addEventListener("click", (event) => this.clicked(event));
      this.body.addEventListener("mouseover", ({target}) => {
        const cell = target.closest("[data-case]");
        if (cell && !cell.title) cell.title = this.said(this.caseAt(cell));
      });
      this.arrange();
      ricochet.later.wait(this.body, () => {
        this.fill();
        this.body.removeAttribute("class");
        this.body.removeAttribute("style");
      });
    }
    arrange() {
      Object.assign(this, layout(this.data, this.cases, this.description.map.along));
      this.across = ordered(this.data, this.cases, this.columns);
      const rows = ordered(this.data, this.cases, this.rows),
            most = Math.max(1, Math.floor(mostCells / this.across.length));
      this.down = rows.slice(0, most);
      this.left = rows.length - this.down.length;
      this.body.style.cssText = "--lines:" + (this.down.length + this.columns.length) + ";--beside:" + aroundMap + "px";
    }
    show(view) {
      super.show(view);
      if (!ricochet.later.waits(this.body)) this.fill();
    }
    get value() { return this.description.map.values[this.view] || null; }
    caseAt(cell) { return this.data.data.byId.get(cell.dataset.case); }
    number(one) {
      const found = one.status === "done" && this.value ? this.value.of(one) : null;
      return Number.isFinite(found) ? found : null;
    }
    said(one) {
      const found = this.number(one),
            known = found === null ? (this.value && one.status === "done" ? ": no " + this.value.quantity[0] : "") :
                                     ": " + text(found, 5) + unit(this.value.quantity);
      return one.id + " · " + this.data.label(one) + " · " + one.status + known + (one.reason ? ": " + one.reason : "");
    }
    // Where a value lies between the palest and the darkest colour.
    scale() {
      const range =
          new Interval().include(...this.cases.map((one) => this.number(one)).filter((found) => found !== null));
      const positive =
          new Interval().include(...this.cases.map((one) => this.number(one)).filter((found) => found > 0));
      const logarithmic = range.low >= 0 && ricochet.logarithmicSweep(positive),
            {low, high} = logarithmic ? positive : range;
      const share = (found) =>
          (high > low ? (logarithmic ? (found > 0 ? Math.log(found / low) / Math.log(high / low) : 0) :
                                       (found - low) / (high - low)) :
                        0.5);
      return {range, low, high, logarithmic, share};
    }

    fill() {
      this.used = new Set();
      const scale = this.scale(), {map} = this.description,
            heads = this.columns.length ? '<p class="fine">Columns: ' + escape(this.heads) + "</p>" : "";
      this.body.innerHTML = this.legend(scale) + heads +
          '<div class="scroll tall"><table class="map"><caption class="hidden">' + escape(this.description.title) +
          "</caption><thead>" + this.head() + "</thead><tbody>" + this.rowsOf(scale) + "</tbody></table></div>" +
          (this.left ? '<p class="fine">' + this.left + " more rows: cases.csv has them.</p>" : "") +
          (map.values.length ? this.extremes() : "");
      ricochet.watchWidth(this.body.querySelector(".scroll"));
      if (this.used.size)
        this.body.insertAdjacentHTML("beforeend", '<p class="fine key">' + escape(ricochet.keyTo(this.used)) + "</p>");
    }
    legend({range, low, high, logarithmic}) {
      const statuses = ["refused", "diverged", "failed"]
                           .filter((status) => this.cases.some((one) => one.status === status))
                           .map((status) => "<span>" + mark(status) + " " + status + "</span>")
                           .join("");
      if (range.empty) return '<p class="map-legend">' + statuses + "</p>";
      const bar = "linear-gradient(to right, " + ramp.join(", ") + ")",
            ends = (value) => escape(text(value, 3) + unit(this.value.quantity));
      return '<p class="map-legend"><span>' + escape(this.value.quantity[0]) + ' ' + ends(low) +
          ' <span class="bar" style="background:' + bar + '"></span> ' + ends(high) +
          (logarithmic ? ", logarithmic" : "") + "</span>" +
          (logarithmic && range.low === 0 ? "<span>0 exactly: 0</span>" : "") + statuses + "</p>";
    }
    // One line of a role stands for the method with its parameters.
    levels(columns) { return Array.from(ricochet.groupBy(columns, (column) => [roleOf(column)]).values()); }
    word(one, columns) { return ricochet.shorten(this.data.label(one, columns) || "–", this.used); }
    // What the lines of the head hold, the outermost first: "N, α (s), h (s)".
    get heads() {
      return this.columns
          .map((column) => ricochet.shorten(ricochet.format.withUnit([column, this.data.unit(column)]), this.used))
          .join(", ");
    }
    head() {
      const levels = this.levels(this.rows),
            sides = '<th scope="col" rowspan="' + Math.max(1, this.columns.length) + '">',
            corner = levels.map((columns) => sides + escape(roleOf(columns[0])) + "</th>").join("") || sides + "</th>";
      const lines = headers(this.data, this.across, this.columns.map((column) => [column]));
      const cells = (line, level) =>
          line.map(
                  ({one, columns, span}) => '<th scope="col" colspan="' + span + '" title="' +
                      escape(this.data.label(one, columns)) + '">' + escape(textOf(one, columns[0]) || "–") + "</th>")
              .join("");
      return (lines.length ? lines : [[]])
          .map((line, level) => "<tr>" + (level === 0 ? corner : "") + cells(line, level) + "</tr>")
          .join("");
    }
    rowsOf(scale) {
      const levels = this.levels(this.rows), sides = headers(this.data, this.down, levels),
            written = this.across.length <= mostWritten;
      return this.down
          .map((row, r) => {
            const heads = sides
                              .map((line, level) => {
                                const found = line.find(({at}) => at === r), last = level === sides.length - 1;
                                if (!found) return "";
                                const said = escape(this.word(found.one, found.columns));
                                return '<th scope="row"' + (last ? ' class="own"' : "") + ' rowspan="' + found.span +
                                    '">' + (last ? this.button(r, said) : said) + "</th>";
                              })
                              .join("") ||
                '<th scope="row">' + this.button(r, "all cases") + "</th>";
            const found = new Map(
                row.cases.map((one) => [ricochet.keyOf(this.columns.map((column) => textOf(one, column))), one]));
            return "<tr>" + heads +
                this.across
                    .map(
                        ({cases: [own]}) => this.cell(
                            found.get(ricochet.keyOf(this.columns.map((column) => textOf(own, column)))), scale,
                            written))
                    .join("") +
                "</tr>";
          })
          .join("");
    }
    button(row, said) {
      return '<button type="button" data-row="' + row + '" title="Draw the charts of this row">' + said + "</button>";
    }
    cell(one, scale, written) {
      if (!one) return '<td class="none"></td>';
      const found = this.number(one), start = '<td data-case="' + escape(one.id) + '"';
      if (one.status !== "done") return start + ' class="' + one.status + '">' + mark(one.status) + "</td>";
      if (found === null) return start + ">" + (this.value ? "–" : mark("done")) + "</td>";
      const share = scale.share(found), said = written ? text(found, 3) : scale.logarithmic && found === 0 ? "0" : "";
      const {contrast} = ricochet.theme, ground = colourAt(share), light = contrast([255, 255, 255], ground) >= 4.6;
      return start + ' style="background:rgb(' + ground + ");color:" + (light ? "#fff" : "#000") + '">' + escape(said) +
          "</td>";
    }
    extremes() {
      const known =
                this.cases.filter((one) => this.number(one) !== null).sort((a, b) => this.number(a) - this.number(b)),
            most = Math.min(listed, known.length >> 1), name = this.value.quantity[0];
      if (!most) return "";
      const table = (title, some) => '<table class="plain"><caption>' + escape(title) +
          '</caption><thead><tr><th scope="col">case</th><th scope="col">what it is</th>' +
          '<th scope="col" class="number">' + escape(ricochet.format.withUnit(this.value.quantity)) +
          "</th></tr></thead><tbody>" +
          some.map(
                  (one) => '<tr><td class="text">' + escape(one.id) + "</td><td>" +
                      escape(ricochet.shorten(this.data.label(one), this.used)) + '</td><td class="number">' +
                      escape(text(this.number(one), 5)) + "</td></tr>")
              .join("") +
          "</tbody></table>";
      return "<details><summary>The " + most + " smallest and the " + most +
          " largest</summary><div class=\"extremes\">" + table("Smallest " + name, known.slice(0, most)) +
          table("Largest " + name, known.slice(-most).reverse()) + "</div></details>";
    }

    clicked({target}) {
      const button = target.closest("[data-row]"), cell = target.closest("[data-case]");
      if (button) this.choose(this.down[Number(button.dataset.row)].cases);
      else if (cell) this.choose(this.down.find(({cases}) => cases.includes(this.caseAt(cell))).cases);
    }
    // Draws the charts of some cases, those of every figure that shares the map.
    choose(cases) {
      const {figures} = this.description.map, shown = new Set(figures.map(({id}) => id + "-row")),
            without = cases.filter(
                (one) => one.status === "done" && this.data.data.page.curves && !this.data.data.page.curves[one.id]);
      ricochet.figures.filter(({description}) => shown.has(description.id)).forEach(ricochet.unmount);
      this.chosen.replaceChildren();
      for (const figure of figures) {
        const charts =
            figure.charts.filter((chart) => chart.cases.some((one) => cases.includes(one))).slice(0, mostCharts);
        if (!charts.some((chart) => chart.views.length)) continue;
        const used = ricochet.drawnNames(charts),
              legend = figure.legend.filter(
                  (entry) => used.has(entry.name) ||
                      charts.some((chart) => chart.views.some(({marks}) => marks.some(({tags}) => tags))));
        ricochet.mount(
            {...figure, id: figure.id + "-row", charts, legend, choices: []}, (section) => this.chosen.append(section));
      }
      if (without.length)
        this.chosen.append(Object.assign(document.createElement("p"), {
          className: "fine",
          textContent: "Curves over time that this page does not hold: " +
              without.map((one) => this.data.data.page.curve_files ? "curves/" + one.id + ".csv" : one.id).join(", ") +
              "."
        }));
      if (this.chosen.firstElementChild) this.chosen.firstElementChild.scrollIntoView({block: "nearest"});
    }
  }

  const mapped = (figure, cases) => {
    const {along = "", values = []} = figure.measured || {}, charts = count(figure.charts.length, "chart", "charts");
    return {
      id: figure.id,
      title: figure.title,
      charts: [],
      legend: [],
      views: values.map((value) => value.view),
      caption: figure.caption + " Its " + charts +
          " are more than a page can show: the map has every case that this page holds, and a click on a row draws " +
          "the charts of that row.",
      map: {view: ricochet.data.view, cases, along, values, figures: [figure]},
    };
  };
  // The figures of a page: each as it is, or as a map where it has too many charts.
  ricochet.bounded = (figures) => {
    const out = [], maps = new Map();
    for (const figure of figures) {
      const atOnce = Math.max(
          0, ...Array.from(ricochet.groupBy(figure.charts, (chart) => [chart.only]).values(), (same) => same.length));
      const cases = ricochet.distinct(figure.charts.flatMap((chart) => chart.cases || [])),
            key = figure.measured ? figure.measured.key : figure.id;
      if (atOnce <= mostCharts || !cases.length) {
        out.push(figure);
        continue;
      }
      if (maps.has(key)) {
        maps.get(key).map.figures.push(figure);
        continue;
      }
      maps.set(key, mapped(figure, cases));
      out.push(maps.get(key));
    }
    return out;
  };
  Object.assign(ricochet, {CaseMap, mapLayout: layout});
}

// What the page holds of the results: cases, tables, curves, and large columns of numbers as little-endian bytes in
// base64, packed where that is worth it.
{
  const types =
      {f32: Float32Array, f64: Float64Array, u8: Uint8Array, u16: Uint16Array, u32: Uint32Array, i16: Int16Array};

  class PageData {
    constructor(page, blocks) {
      this.page = page;
      this.blocks = blocks;
      this.decoded = new Map();
      this.tables = new Map();
      this.study = page.study;
      this.cases = page.cases.id.map((id, index) => this.caseOf(index));
      this.byId = new Map(this.cases.map((one) => [one.id, one]));
    }
    caseOf(index) {
      const {cases} = this.page, values = {}, measures = {};
      for (const axis of this.page.axes) {
        const at = axis.at[index];
        if (at >= 0) values[axis.name] = {text: axis.texts[at], number: axis.numbers[at]};
      }
      for (const [name, column] of Object.entries(cases.measures))
        if (column[index] !== null) measures[name] = column[index];
      return {
        index,
        id: cases.id[index],
        status: cases.status[index],
        reason: cases.reason[index],
        mass: this.page.masses[cases.mass[index]],
        colour: cases.colour[index],
        partial: cases.partial[index],
        values,
        measures
      };
    }

    // How answers call a measure: "energy lost at the stops".
    measureWords(name) {
      return (this.page.measures.find((one) => one.name === name) || {}).words || ricochet.format.spaced(name);
    }
    // Rows of a derived table as objects; none where the results have no such table.
    rows(name) {
      if (!this.tables.has(name)) this.tables.set(name, rowsOf((this.page.tables || {})[name]));
      return this.tables.get(name);
    }
    // Rows of a table that a case left by itself.
    ownRows(name, id) {
      const key = name + "/" + id;
      if (!this.tables.has(key)) this.tables.set(key, rowsOf(((this.page.own || {})[name] || {})[id]));
      return this.tables.get(key);
    }
    // Rows of a table by the values that they have in columns: none where no row has them.
    rowsBy(name, columns) {
      // Texts and numbers are told alike, whatever digits they are written with.
      const groups = ricochet.groupBy(this.rows(name), (row) => columns.map((column) => row[column]));
      return (...values) => groups.get(ricochet.keyOf(values)) || [];
    }
    // Finds the row of a table with a case's axes and the values of further columns. `but`: axes that are not looked
    // at.
    finder(name, columns, but = []) {
      const [first = {}] = this.rows(name),
                     axes =
                         this.page.axes.map((axis) => axis.name).filter((axis) => axis in first && !but.includes(axis));
      const found = this.rowsBy(name, axes.concat(columns)),
            part = (value) => value && (value.number === null ? value.text : value.number);
      return (one, wanted) => found(...axes.map((axis) => part(one.values[axis])), ...wanted)[0];
    }

    // A block of numbers; null where the page has none of the name.
    block(name) {
      if (!this.decoded.has(name)) {
        const held = (type) => this.blocks[name + ":" + type],
              type = Object.keys(types).find((one) => held(one) !== undefined || held(one + "z") !== undefined);
        if (!type) return null;
        const bytes = held(type) === undefined ?
            ricochet.unpacked(bytesOf(held(type + "z")), types[type].BYTES_PER_ELEMENT) :
            bytesOf(held(type));
        this.decoded.set(name, new types[type](bytes.buffer));  // as every browser's machine has them
      }
      return this.decoded.get(name);
    }
    // Columns of a case's curve, {x, y}; null where it has none.
    curve(one, column) {
      const names = ((this.page.curves || {})[one.id] || {})[column];
      return names ? {x: this.block(names[0]), y: this.block(names[1])} : null;
    }
  }

  function bytesOf(text) {
    const binary = atob(text), bytes = new Uint8Array(binary.length);
    for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
    return bytes;
  }
  function rowsOf(table) {
    if (!table) return [];
    const names = table.columns.map((column) => column.name), rows = [];
    for (let r = 0; r < table.rows; ++r) {
      const row = {};
      names.forEach((name, c) => {
        const column = table.cells[c];
        row[name] = column.words ? (column.at[r] < 0 ? null : column.words[column.at[r]]) : column[r];
      });
      rows.push(row);
    }
    return rows;
  }

  ricochet.PageData = PageData;
}

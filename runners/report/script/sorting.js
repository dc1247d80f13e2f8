// A number as it is written: "−1.2e-7"; not a number where it is a word.
ricochet.numberWritten = (text) =>
    (/^[−-]?[\d.∞]/.test(text) ? Number(text.replace("−", "-").replace("∞", "Infinity")) : NaN);

// Sorts a table by a click on a header; rows without a value stand last, either way.
ricochet.startSorting = (table) => {
  const body = table.tBodies[0], headers = Array.from(table.querySelectorAll("thead th"));
  const absent = (v) => v === "–" || v === "";
  function sort(header) {
    const index = headers.indexOf(header), up = header.getAttribute("aria-sort") !== "ascending";
    headers.forEach((h) => h.setAttribute("aria-sort", "none"));
    header.setAttribute("aria-sort", up ? "ascending" : "descending");
    const key = (row) => {
      const cell = row.cells[index], text = cell.textContent.trim(),
            v = cell.dataset.value === undefined ? ricochet.numberWritten(text) : Number(cell.dataset.value);
      return Number.isNaN(v) ? text : v;
    };
    const compare = (a, b) => {
      const x = key(a), y = key(b);
      if (absent(x) || absent(y)) return absent(x) - absent(y);
      if (typeof x !== typeof y) return typeof x === "number" ? -1 : 1;
      const order = typeof x === "number" ? x - y : x.localeCompare(y);
      return up ? order : -order;
    };
    Array.from(body.rows).sort(compare).forEach((row) => body.appendChild(row));
  }
  headers.forEach((h) => {
    const button = h.querySelector("button");
    if (button) button.addEventListener("click", () => sort(h));
  });
};

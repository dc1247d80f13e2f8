// What a filter's text asks of rows: words that must appear, and conditions on columns, `energy_left > 0.4`, `status =
// refused`, `mass != singular`. A column goes by the name that cases.csv gives it, with "_" or blanks; numbers are
// compared as numbers, texts without regard to case.
{
  const compare = {
    "=": (a, b) => a === b || near(a, b),
    "!=": (a, b) => !(a === b || near(a, b)),
    "<": (a, b) => a < b,
    ">": (a, b) => a > b,
    "<=": (a, b) => a <= b || near(a, b),
    ">=": (a, b) => a >= b || near(a, b),
  };
  const spelled = {"==": "=", "≠": "!=", "≤": "<=", "≥": ">="}, operators = "<=|>=|!=|==|=|<|>|≤|≥|≠";
  // As equal as a number typed from a table can be.
  const near = (a, b) => typeof a === "number" && typeof b === "number" && Math.abs(a - b) <= 1e-6 * Math.abs(b);
  const plain = (text) => text.toLowerCase().replace(/[_\s]+/g, " ").trim();
  const valueOf = (text) => {
    const number = Number(text.replace("−", "-"));
    return text.trim() === "" || Number.isNaN(number) ? plain(text) : number;
  };

  // Steps of one letter from one word to another.
  function distance(a, b) {
    let row = Array.from({length: b.length + 1}, (_, k) => k);
    for (let i = 1; i <= a.length; ++i) {
      const next = [i];
      for (let j = 1; j <= b.length; ++j)
        next[j] = Math.min(row[j] + 1, next[j - 1] + 1, row[j - 1] + (a[i - 1] === b[j - 1] ? 0 : 1));
      row = next;
    }
    return row[b.length];
  }
  function nearest(name, columns) {
    const best = columns.map((column) => [distance(plain(name), plain(column)), column]).sort((a, b) => a[0] - b[0])[0];
    return best && best[0] <= Math.max(2, name.length / 3) ? best[1] : "";
  }

  // {words, conditions: [{column, holds(value)}], wrong}: `wrong` says what is no condition, "" where all is well.
  ricochet.readFilter = (text, columns) => {
    const names = columns.slice()
                      .sort((a, b) => b.length - a.length)
                      .map((name) => name.replace(/[.*+?^${}()|[\]\\]/g, "\\$&").replace(/_/g, "[_ ]"));
    const condition = new RegExp("(^|\\s)(" + names.join("|") + ")\\s*(" + operators + ")\\s*(\"[^\"]*\"|\\S+)", "gi"),
          conditions = [];
    const words = text.replace(condition, (all, before, name, operator, value) => {
      const wanted = valueOf(value.replace(/^"|"$/g, "")), test = compare[spelled[operator] || operator];
      conditions.push({
        column: columns.find((column) => plain(column) === plain(name)),
        holds: (have) => have !== null && typeof have === typeof wanted && test(have, wanted)
      });
      return " ";
    });
    const left = new RegExp("(\\S*)\\s*(" + operators + ")").exec(words);
    if (!left) return {words: plain(words).split(" ").filter(Boolean), conditions, wrong: ""};
    const name = left[1], known = columns.some((column) => plain(column) === plain(name)),
          near = known ? "" : nearest(name, columns);
    return {
      words: [],
      conditions: [],
      wrong: known ? name + " " + left[2] + " expects a value" :
                     "no column is called “" + name + "”" + (near ? "; did you mean " + near + "?" : "")
    };
  };
  // The words of a cell, without the mark of a status.
  ricochet.cellText = (cell) => cell.textContent.trim().replace(/^[✓⊘✕!?] /, "");
  // What a cell has: a number, a text, null for nothing.
  ricochet.cellValue = (cell) => {
    const text = ricochet.cellText(cell),
          number = cell.dataset.value === undefined && !cell.classList.contains("text") ? ricochet.numberWritten(text) :
                                                                                          Number(cell.dataset.value);
    return text === "" || text === "–" ? null : Number.isNaN(number) ? plain(text) : number;
  };
}

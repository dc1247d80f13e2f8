// Numbers and names as all figures write them. A quantity is [name, unit].
const ricochet = {};
ricochet.distinct = (list) => Array.from(new Set(list));
// Lists of what has the same values, in order of appearance: `valuesOf` gives these, and nothing is told apart from "".
ricochet.groupBy = (list, valuesOf) => {
  const groups = new Map();
  for (const one of list) {
    const key = ricochet.keyOf(valuesOf(one));
    if (!groups.has(key)) groups.set(key, []);
    groups.get(key).push(one);
  }
  return groups;
};
ricochet.keyOf = (values) =>
    values.map((value) => (value === null || value === undefined ? "" : String(value))).join("\u001f");
{
  const minus = (text) => text.replace("-", "−");

  // The digits of a number: 0.00025 → ["-" or "", "25", −4].
  function digitsOf(value, text) {
    const [mantissa, exponent] = (text || Math.abs(value).toExponential()).split("e");
    return {
      sign: value < 0 ? "-" : "",
      digits: mantissa.replace(".", "").replace(/0+$/, "") || "0",
      exponent: Number(exponent)
    };
  }
  const scientific = ({sign, digits, exponent}) =>
      sign + digits[0] + (digits.length > 1 ? "." + digits.slice(1) : "") + "e" + exponent;
  function plain({sign, digits, exponent}) {
    if (exponent < 0)
      return sign + "0." +
          "0".repeat(-exponent - 1) + digits;
    if (digits.length <= exponent + 1) return sign + digits + "0".repeat(exponent + 1 - digits.length);
    return sign + digits.slice(0, exponent + 1) + "." + digits.slice(exponent + 1);
  }

  // `digits` significant digits, exponents short: "0.02431", "1.2e-7".
  function text(value, digits = 4) {
    if (Number.isNaN(value)) return "not a number";
    if (!Number.isFinite(value)) return value > 0 ? "∞" : "−∞";
    if (value === 0) return "0";
    const parts = digitsOf(value, Math.abs(value).toExponential(digits - 1));
    const far = parts.exponent < -4 || parts.exponent >= digits, written = far ? scientific(parts) : plain(parts);
    return written[0] === "-" ? minus(written) : written;
  }

  // The shortest text that reads back as the same number, as the tables' files have it: "0.25", "1e-7".
  function exact(value) {
    if (value === 0) return "0";
    const parts = digitsOf(value), fixed = plain(parts), short = scientific(parts);
    // The files' writer counts at least two digits of an exponent, and its sign.
    const counted = short.length + (parts.exponent >= 0 ? 1 : 0) + (Math.abs(parts.exponent) < 10 ? 1 : 0);
    return fixed.length <= counted ? fixed : short;
  }

  // A number on an axis or in a hover text.
  function shown(value, digits = 6) {
    if (!Number.isFinite(value)) return "–";
    let out = Number(value.toPrecision(digits));
    out = out !== 0 && (Math.abs(out) < 1e-3 || Math.abs(out) >= 1e6) ? out.toExponential() : String(out);
    return out.replace("e+", "e").replace("-", "−").replace("e-", "e−");
  }

  const superscript = (n) => String(n).replace(/./g, (c) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(c)]);
  // A label of a logarithmic axis: whole powers of ten alone.
  function power(value) {
    const k = Math.log10(value);
    if (Math.abs(k - Math.round(k)) > 1e-6) return "";
    return k >= 0 && k <= 2 ? String(Math.round(value)) : "10" + superscript(Math.round(k));
  }

  const twoDecimals = (value) => (value.toFixed(2) === "-0.00" ? "0.00" : minus(value.toFixed(2)));
  const unitless = (unit) => unit === "" || unit === "1";
  const marks = {done: "✓", refused: "⊘", diverged: "✕", failed: "!"};

  ricochet.format = {
    text,
    exact,
    shown,
    power,
    // An order of convergence: "1.00", "−0.03".
    order: twoDecimals,
    // A share of a variance: two digits where it is small, no decimals where it is not.
    percent: (share) => (share < 0.095 ? text(100 * share, 2) : (100 * share).toFixed(0)) + " %",
    // A share to three significant digits, however small.
    share: (share) => text(100 * share, 3) + " %",
    count: (n, singular, plural) => n + " " + (n === 1 ? singular : plural),
    withUnit: ([name, unit]) => (unitless(unit) ? name : name + " (" + unit + ")"),
    unit: ([, unit]) => (unitless(unit) ? "" : " " + unit),
    mark: (status) => marks[status] || "?",
    spaced: (name) => name.replace(/_/g, " ").replace(/\[(.*)\]$/, " at $1"),
    escape: (value) => String(value).replace(/[&<>"']/g, (c) => "&#" + c.charCodeAt(0) + ";"),
  };
}

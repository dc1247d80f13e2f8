// Blocks of numbers as the program packs them: gzip (RFC 1952) without a name, deflate (RFC 1951) within, and the first
// bytes of all numbers before their second ones. Browsers unpack by themselves only later, when a page is there.
{
  const lengths = [
    3, 4, 5, 6, 7, 8, 9, 10, 11, 13, 15, 17, 19, 23, 27, 31, 35, 43, 51, 59, 67, 83, 99, 115, 131, 163, 195, 227, 258
  ];
  const distances = [
    1,   2,   3,   4,   5,   7,    9,    13,   17,   25,   33,   49,   65,    97,    129,
    193, 257, 385, 513, 769, 1025, 1537, 2049, 3073, 4097, 6145, 8193, 12289, 16385, 24577
  ];
  const moreOfLength = (k) => (k < 8 || k === 28 ? 0 : (k >> 2) - 1),
        moreOfDistance = (k) => (k < 4 ? 0 : (k >> 1) - 1),
        order = [16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15];

  // Codes by their lengths: how many have each, and what they stand for.
  function codesOf(sizes) {
    const counts = new Uint16Array(16), next = new Uint16Array(16), symbols = new Uint16Array(sizes.length);
    for (const size of sizes) ++counts[size];
    counts[0] = 0;
    for (let k = 1; k < 16; ++k) next[k] = next[k - 1] + counts[k - 1];
    sizes.forEach((size, symbol) => {
      if (size) symbols[next[size]++] = symbol;
    });
    return {counts, symbols};
  }
  const fixed = [
    codesOf(Array.from(
        {length: 288},
        (_, k) =>
            (k < 144     ? 8 :
                 k < 256 ? 9 :
                 k < 280 ? 7 :
                           8))),
    codesOf(Array(30).fill(5))
  ];

  function inflated(source, from, out) {
    let at = from, held = 0, count = 0, to = 0;
    function bits(n) {
      while (count < n) {
        held |= source[at++] << count;
        count += 8;
      }
      const value = held & ((1 << n) - 1);
      held >>>= n;
      count -= n;
      return value;
    }
    function symbol({counts, symbols}) {
      let code = 0, first = 0, index = 0;
      for (let size = 1; size < 16; ++size) {
        if (!count) {
          held = source[at++];
          count = 8;
        }
        code |= held & 1;
        held >>>= 1;
        --count;
        if (code - counts[size] < first) return symbols[index + code - first];
        index += counts[size];
        first = (first + counts[size]) << 1;
        code <<= 1;
      }
      throw new Error("a block of the page is damaged");
    }
    function written() {
      const literals = bits(5) + 257, sizes = bits(5) + 1, own = Array(19).fill(0), all = [];
      for (let k = 0, n = bits(4) + 4; k < n; ++k) own[order[k]] = bits(3);
      const codes = codesOf(own);
      while (all.length < literals + sizes) {
        const found = symbol(codes);
        if (found < 16) all.push(found);
        else {
          const value = found === 16 ? all[all.length - 1] : 0;
          for (let n = found === 16 ? 3 + bits(2) : found === 17 ? 3 + bits(3) : 11 + bits(7); n > 0; --n)
            all.push(value);
        }
      }
      return [codesOf(all.slice(0, literals)), codesOf(all.slice(literals))];
    }
    for (let last = 0; !last;) {
      last = bits(1);
      const kind = bits(2);
      if (kind === 0) {
        held = count = 0;
        const size = source[at] | (source[at + 1] << 8);
        out.set(source.subarray(at + 4, at + 4 + size), to);
        at += 4 + size;
        to += size;
        continue;
      }
      const [literal, distance] = kind === 1 ? fixed : written();
      for (let found = symbol(literal); found !== 256; found = symbol(literal)) {
        if (found < 256) {
          out[to++] = found;
          continue;
        }
        const length = lengths[found - 257] + bits(moreOfLength(found - 257)), k = symbol(distance),
              back = distances[k] + bits(moreOfDistance(k));
        for (let n = 0; n < length; ++n, ++to) out[to] = out[to - back];
      }
    }
  }

  // The numbers' bytes; `width`: bytes of a number.
  ricochet.unpacked = (source, width) => {
    const end = source.length,
          size = source[end - 4] | (source[end - 3] << 8) | (source[end - 2] << 16) | (source[end - 1] << 24),
          turned = new Uint8Array(size), out = new Uint8Array(size), count = size / width;
    inflated(source, 10, turned);
    for (let k = 0; k < width; ++k)
      for (let i = 0; i < count; ++i) out[width * i + k] = turned[count * k + i];
    return out;
  };
}

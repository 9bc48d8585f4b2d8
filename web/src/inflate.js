// Unpacks zlib streams (RFC 1950, RFC 1951) at once: what the page packs has to be there before anything is drawn.
// SPDX-License-Identifier: Apache-2.0

const kLengthBase = [3, 4, 5, 6, 7, 8, 9, 10, 11, 13, 15, 17, 19, 23, 27, 31, 35, 43, 51, 59, 67, 83, 99, 115, 131, 163, 195, 227, 258];
const kLengthBits = [0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 0];
const kDistanceBase = [1, 2, 3, 4, 5, 7, 9, 13, 17, 25, 33, 49, 65, 97, 129, 193, 257, 385, 513, 769, 1025, 1537, 2049, 3073, 4097, 6145, 8193, 12289, 16385, 24577];
const kOrder = [16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15]; // of code lengths, RFC 1951, 3.2.7
const kEnd = 256, kLiterals = 288, kDistances = 30, kLongest = 15;
const kHeader = 2; // bytes of zlib's; its checksum is left unread

class Bits {
  constructor(bytes) {
    Object.assign(this, { bytes, at: kHeader, hold: 0, count: 0 });
  }
  take(wanted) {
    for (; this.count < wanted; this.count += 8) this.hold |= this.bytes[this.at++] << this.count;
    const value = this.hold & ((1 << wanted) - 1);
    this.hold >>>= wanted;
    this.count -= wanted;
    return value;
  }
  skipToByte() {
    this.hold = this.count = 0;
  }
}

// Canonical Huffman code: how many codes there are of each length, and the symbols in order of their codes.
function codeOf(lengths) {
  const counts = new Array(kLongest + 1).fill(0), symbols = [];
  for (const length of lengths) counts[length]++;
  for (let length = 1; length <= kLongest; ++length) lengths.forEach((of, symbol) => of === length && symbols.push(symbol));
  return { counts, symbols };
}

function symbolOf(bits, { counts, symbols }) {
  for (let length = 1, code = 0, first = 0, index = 0; length <= kLongest; ++length) {
    code |= bits.take(1);
    if (code - counts[length] < first) return symbols[index + code - first];
    index += counts[length];
    first = (first + counts[length]) << 1;
    code <<= 1;
  }
  throw new Error("a packed part of this page is damaged");
}

function fixedCodes() {
  const lengths = Array.from({ length: kLiterals }, (_, i) => (i < 144 ? 8 : i < 256 ? 9 : i < 280 ? 7 : 8));
  return [codeOf(lengths), codeOf(new Array(kDistances).fill(5))];
}

function dynamicCodes(bits) {
  const literals = bits.take(5) + 257, distances = bits.take(5) + 1, known = bits.take(4) + 4;
  const first = new Array(kOrder.length).fill(0);
  for (let i = 0; i < known; ++i) first[kOrder[i]] = bits.take(3);
  const code = codeOf(first), lengths = [];
  while (lengths.length < literals + distances) {
    const symbol = symbolOf(bits, code);
    if (symbol < 16) lengths.push(symbol);
    else if (symbol === 16) lengths.push(...new Array(3 + bits.take(2)).fill(lengths[lengths.length - 1]));
    else lengths.push(...new Array(symbol === 17 ? 3 + bits.take(3) : 11 + bits.take(7)).fill(0));
  }
  return [codeOf(lengths.slice(0, literals)), codeOf(lengths.slice(literals))];
}

// `size`: of what comes out, in bytes.
export function inflate(packed, size) {
  const bits = new Bits(packed), out = new Uint8Array(size);
  let at = 0, isLast = 0;
  while (!isLast) {
    isLast = bits.take(1);
    const kind = bits.take(2);
    if (kind === 0) {
      bits.skipToByte();
      const length = packed[bits.at] | (packed[bits.at + 1] << 8);
      out.set(packed.subarray(bits.at + 4, bits.at + 4 + length), at);
      bits.at += 4 + length;
      at += length;
      continue;
    }
    const [literals, distances] = kind === 1 ? fixedCodes() : dynamicCodes(bits);
    for (let symbol = symbolOf(bits, literals); symbol !== kEnd; symbol = symbolOf(bits, literals)) {
      if (symbol < kEnd) {
        out[at++] = symbol;
        continue;
      }
      let length = kLengthBase[symbol - 257] + bits.take(kLengthBits[symbol - 257]);
      const code = symbolOf(bits, distances);
      const distance = kDistanceBase[code] + bits.take(code < 2 ? 0 : (code >> 1) - 1);
      for (; length > 0; --length, ++at) out[at] = out[at - distance];
    }
  }
  return out;
}

// Of base64 of a zlib stream of UTF-8.
export function unpackText(base64, size) {
  return new TextDecoder().decode(inflate(Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0)), size));
}

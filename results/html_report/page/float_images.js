// ---- Float images: half-floats, deflated, in base64 on the page or in a file beside it. They are
// read when first asked for; see float_payload.h for the bytes.

// The value of all 65536 half-floats.
const halfValues = (() => {
  const values = new Float32Array(65536);
  for (let bits = 0; bits < 32768; ++bits) {
    const exponent = bits >> 10;
    const fraction = bits & 1023;
    let value = fraction * 2 ** -24;
    if (exponent === 31) value = fraction ? NaN : Infinity;
    else if (exponent > 0) value = (1024 + fraction) * 2 ** (exponent - 25);
    values[bits] = value;
    values[bits | 32768] = -value;
  }
  return values;
})();

const isFiniteHalf = bits => (bits & 0x7c00) !== 0x7c00;

class FloatImage {
  constructor(description, halfs) {
    this.width = description.width;
    this.height = description.height;
    this.channels = description.channels;
    this.scale = 2 ** description.exponent;
    this.nonFinite = description.non_finite;
    this.halfs = halfs;  // row-major, channels interleaved
  }

  at(x, y, channel) {
    return halfValues[this.halfs[(y * this.width + x) * this.channels + channel]] * this.scale;
  }

  pixel(x, y) {
    const values = [];
    for (let c = 0; c < this.channels; ++c) values.push(this.at(x, y, c));
    return values;
  }

  // Places of pixels that are not finite, at most `most`.
  nonFinitePlaces(most) {
    const places = [];
    if (this.nonFinite === 0) return places;
    const count = this.width * this.height;
    for (let i = 0; i < count && places.length < most; ++i) {
      for (let c = 0; c < this.channels; ++c) {
        if (isFiniteHalf(this.halfs[i * this.channels + c])) continue;
        places.push({x: i % this.width, y: Math.floor(i / this.width)});
        break;
      }
    }
    return places;
  }
}

// Texts of files that a split page has asked for, by id: who waits for them.
const awaitedTexts = new Map();

function discernData(id, text) {
  const waiting = awaitedTexts.get(id);
  if (waiting) waiting.resolve(text);
}

function textFromFile(id) {
  return new Promise((resolve, reject) => {
    awaitedTexts.set(id, {resolve});
    const script = document.createElement('script');
    script.src = `data/${id}.js`;
    script.onerror = () => reject(new Error(`data/${id}.js cannot be read`));
    script.onload = () => script.remove();
    document.head.append(script);
  }).finally(() => awaitedTexts.delete(id));
}

const pageIsRead = new Promise(resolve => {
  if (document.readyState !== 'loading') resolve();
  else document.addEventListener('DOMContentLoaded', resolve, {once: true});
});

async function textOf(id) {
  if (!document.getElementById(id)) await pageIsRead;  // data follow the rest of the page
  const element = document.getElementById(id);
  return element ? element.textContent : textFromFile(id);
}

function bytesOfBase64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

async function inflated(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Undoes the prediction from the left neighbour and the split into high and low bytes.
function unpackHalfs(bytes, {width, height, channels}) {
  const count = width * height;
  const halfs = new Uint16Array(count * channels);
  for (let c = 0; c < channels; ++c) {
    const high = 2 * count * c;
    const low = high + count;
    for (let y = 0; y < height; ++y) {
      let bits = 0;
      for (let i = y * width, end = i + width; i < end; ++i) {
        bits = (bits + (bytes[high + i] << 8) + bytes[low + i]) & 0xffff;
        halfs[i * channels + c] = bits;
      }
    }
  }
  return halfs;
}

// Decoded images, the least recently used ones dropped beyond a size.
class FloatCache {
  constructor(mostBytes) {
    this.mostBytes = mostBytes;
    this.bytes = 0;
    this.images = new Map();
    this.loading = new Map();
    this.failures = new Map();
  }

  // The image, or null while it is not decoded.
  peek(description) {
    const image = this.images.get(description.id);
    if (!image) return null;
    this.images.delete(description.id);
    this.images.set(description.id, image);
    return image;
  }

  failure(description) { return this.failures.get(description.id); }

  load(description) {
    const {id} = description;
    const known = this.images.get(id);
    if (known) return Promise.resolve(known);
    if (!this.loading.has(id)) {
      this.loading.set(id, this.decode(description).finally(() => this.loading.delete(id)));
    }
    return this.loading.get(id);
  }

  async decode(description) {
    try {
      const bytes = await inflated(bytesOfBase64(await textOf(description.id)));
      const image = new FloatImage(description, unpackHalfs(bytes, description));
      this.images.set(description.id, image);
      this.bytes += image.halfs.byteLength;
      this.dropOldest();
      return image;
    } catch (error) {
      this.failures.set(description.id, String(error.message || error));
      return null;
    }
  }

  dropOldest() {
    for (const [id, image] of this.images) {
      if (this.bytes <= this.mostBytes || this.images.size <= 8) return;
      this.images.delete(id);
      this.bytes -= image.halfs.byteLength;
    }
  }
}

const floatCache = new FloatCache(768 * 2 ** 20);

// ---- Colours: how floats become what is shown. The same tables serve WebGL and the 2D canvas.

const kCurveNames = {
  srgb: 'sRGB', linear: 'linear', reinhard: 'filmic (Reinhard)', aces: 'filmic (ACES fit)',
};
const kCurves = Object.keys(kCurveNames);
const kNonFiniteColor = [0, 255, 255];  // cyan, as in the error maps
const kLuminance = [0.2126, 0.7152, 0.0722];  // ITU-R BT.709
const kRelativeEpsilon = 0.01;

// IEC 61966-2-1.
const encodeSrgb = v => v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055;

// Light that a display shows of scene light v >= 0, channel by channel. ACES: the fit of Narkowicz
// 2015, "ACES Filmic Tone Mapping Curve", without the factor of 0.6 that the metric flip has before it.
const kToneCurves = {
  srgb: v => v,
  reinhard: v => v / (1 + v),  // Reinhard et al. 2002, Eq. 3
  aces: v => v * (2.51 * v + 0.03) / (v * (2.43 * v + 0.59) + 0.14),
};

function toneByte(value, curve) {
  if (curve === 'linear') return Math.round(255 * clamp(value, 0, 1));
  const kWhite = 65504;  // shown as 1 by every curve; keeps infinity out of quotients
  const shown = kToneCurves[curve](clamp(value, 0, kWhite));
  return Math.round(255 * encodeSrgb(Math.min(1, shown)));
}

// 256 colours of a map from its anchors, which are equally spaced.
function colorTable(anchors) {
  const table = new Uint8ClampedArray(256 * 4);
  for (let i = 0; i < 256; ++i) {
    const place = i / 255 * (anchors.length - 1);
    const low = Math.min(Math.floor(place), anchors.length - 2);
    for (let c = 0; c < 3; ++c) {
      table[4 * i + c] =
          Math.round(anchors[low][c] + (place - low) * (anchors[low + 1][c] - anchors[low][c]));
    }
    table[4 * i + 3] = 255;
  }
  return table;
}

// Blue - black - orange: told apart by every kind of colour vision.
const kSignedAnchors = [
  [176, 214, 255], [86, 152, 240], [32, 92, 190], [18, 44, 92], [16, 17, 20],
  [92, 44, 10], [188, 92, 16], [244, 152, 54], [255, 218, 160],
];

// Position of a value on a scale, 0 to 1. A signed scale has its low bound on both sides of the
// middle: smaller values are in the middle.
function scalePosition(value, scale, isSigned) {
  if (isSigned) {
    const size = Math.abs(value);
    if (size <= scale.low) return 0.5;
    const share = Math.min(1, Math.log(size / scale.low) / Math.log(scale.high / scale.low));
    return 0.5 + 0.5 * Math.sign(value) * share;
  }
  if (value <= scale.low) return 0;
  if (value >= scale.high) return 1;
  return scale.logarithmic ? Math.log(value / scale.low) / Math.log(scale.high / scale.low)
                           : (value - scale.low) / (scale.high - scale.low);
}

// The number that a difference mode makes of two pixels; NaN where one is not finite.
function differenceOf(mode, test, reference) {
  const channels = test.length;
  let sum = 0;
  for (let c = 0; c < channels; ++c) {
    const difference = test[c] - reference[c];
    if (!Number.isFinite(difference)) return NaN;
    if (mode === 'signed') sum += difference * (channels === 3 ? kLuminance[c] : 1);
    else if (mode === 'absolute') sum += Math.abs(difference) / channels;
    else if (mode === 'squared') sum += difference * difference / channels;
    else sum += Math.abs(difference) / (Math.abs(reference[c]) + kRelativeEpsilon) / channels;
  }
  return sum;
}

const kDifferences = {
  signed: {name: 'signed difference', formula: 'luminance of (x − r)', table: 'signed'},
  absolute: {name: 'absolute difference', formula: 'mean of |x − r| over R, G, B', table: 'map'},
  relative: {name: 'relative difference', formula: 'mean of |x − r| / (|r| + 0.01)', table: 'map'},
  squared: {name: 'squared difference', formula: 'mean of (x − r)²', table: 'map'},
};

function formatNumber(value, digits = 4) {
  if (Number.isNaN(value)) return 'NaN';
  if (!Number.isFinite(value)) return value > 0 ? '+inf' : '−inf';
  if (value === 0) return '0';
  const size = Math.abs(value);
  let text = value.toPrecision(digits);
  if (size < 1e-4 || size >= 1e6) text = value.toExponential(Math.max(1, digits - 2));
  else if (size >= 10 ** digits) text = String(Math.round(value));
  return text.replaceAll('-', '−');
}

// Ticks of a scale: powers of ten, or six equal steps.
function scaleTicks(scale, isSigned) {
  if (!scale.logarithmic) {
    const step = (scale.high - scale.low) / 5;
    return [0, 1, 2, 3, 4, 5].map(i => scale.low + i * step);
  }
  const ticks = [];
  const last = Math.floor(Math.log10(scale.high) + 1e-9);
  for (let e = Math.ceil(Math.log10(scale.low) - 1e-9); e <= last; ++e) ticks.push(10 ** e);
  return isSigned ? [...ticks.map(t => -t).reverse(), ...ticks].filter(
                        t => Math.abs(t) > scale.low * 1.5).concat(0)
                  : ticks;
}

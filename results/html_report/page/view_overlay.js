// ---- What lies over the images: numbers on large pixels, marks of pixels that are not finite,
// the region, the edge of the wipe; and the colour bar of a mode.

const kNumbersFromZoom = 32;  // CSS pixels per pixel
const kMostMarks = 200;

function pixelText(pane, x, y) {
  const {mode, test, reference} = pane.shown;
  if (mode.isDifference) {
    const value = differenceOf(mode.key, test.pixel(x, y), reference.pixel(x, y));
    return [formatNumber(value, 3)];
  }
  return test.pixel(x, y).map(value => formatNumber(value, 3));
}

// sRGB bytes that a pixel is shown in.
function pixelColor(pane, x, y, displays, state) {
  const {mode, test, reference} = pane.shown;
  if (mode.isDifference || mode.isMap) {
    const value = mode.isMap ? test.at(x, y, 0)
                             : differenceOf(mode.key, test.pixel(x, y), reference.pixel(x, y));
    if (!Number.isFinite(value)) return kNonFiniteColor;
    const position = scalePosition(value, mode.scale, mode.table === 'signed');
    return colorTables[mode.table].subarray(4 * Math.floor(position * 255 + 0.5)).slice(0, 3);
  }
  const values = test.pixel(x, y);
  if (!values.every(Number.isFinite)) return kNonFiniteColor;
  const tone = displays.toneOf(test, state);
  const at = (y * test.width + x) * test.channels;
  return [0, 1, 2].map(c => tone[test.halfs[at + (test.channels === 3 ? c : 0)]]);
}

const isDark = ([r, g, b]) => 0.2126 * r + 0.7152 * g + 0.0722 * b < 130;

class Overlay {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext('2d');
  }

  begin(width, height, ratio) {
    if (this.canvas.width !== width) this.canvas.width = width;
    if (this.canvas.height !== height) this.canvas.height = height;
    this.context.setTransform(1, 0, 0, 1, 0, 0);
    this.context.clearRect(0, 0, width, height);
    this.context.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.numbersDrawn = 0;
    this.marksDrawn = 0;
  }

  // pane: {box, place, shown}, in CSS pixels of the stage.
  drawPane(pane, state, displays) {
    const {context} = this;
    const {box, place} = pane;
    context.save();
    context.beginPath();
    context.rect(box.x, box.y, box.width, box.height);
    context.clip();
    if (pane.shown.test) {
      const pixel = place.width / pane.shown.test.width;
      if (pixel >= kNumbersFromZoom) this.drawNumbers(pane, pixel, displays, state);
      else this.drawMarks(pane, pixel);
    }
    if (state.region) this.drawRegion(place, state);
    context.restore();
  }

  drawNumbers(pane, pixel, displays, state) {
    const {context} = this;
    const {box, place} = pane;
    const {test} = pane.shown;
    const first = (from, at) => Math.max(0, Math.floor((from - at) / pixel));
    const end = (to, at, count) => Math.min(count, Math.ceil((to - at) / pixel));
    context.textAlign = 'center';
    context.textBaseline = 'middle';
    const size = Math.min(14, pixel / 4.4);
    context.font = `${size}px ui-monospace, "DejaVu Sans Mono", monospace`;
    for (let y = first(box.y, place.y); y < end(box.y + box.height, place.y, test.height); ++y) {
      for (let x = first(box.x, place.x); x < end(box.x + box.width, place.x, test.width); ++x) {
        const lines = pixelText(pane, x, y);
        context.fillStyle = isDark(pixelColor(pane, x, y, displays, state)) ? '#ffffff' : '#000000';
        lines.forEach((line, i) => context.fillText(
            line, place.x + (x + 0.5) * pixel,
            place.y + (y + 0.5) * pixel + (i - (lines.length - 1) / 2) * 1.2 * size));
        ++this.numbersDrawn;
      }
    }
  }

  // A ring around pixels that are not finite: on a small scale one pixel would not be seen.
  drawMarks(pane, pixel) {
    const {context} = this;
    const {place} = pane;
    for (const image of [pane.shown.test, pane.shown.reference]) {
      if (!image) continue;
      image.marks ??= image.nonFinitePlaces(kMostMarks);
      for (const {x, y} of image.marks) {
        for (const [style, width] of [['#000000', 4], ['#00ffff', 2]]) {
          context.beginPath();
          context.arc(place.x + (x + 0.5) * pixel, place.y + (y + 0.5) * pixel,
                      Math.max(6, 0.9 * pixel), 0, 2 * Math.PI);
          context.strokeStyle = style;
          context.lineWidth = width;
          context.stroke();
        }
        ++this.marksDrawn;
      }
    }
  }

  drawRegion(place, {region, scene}) {
    const {context} = this;
    const pixel = place.width / scene.width;
    const box = [place.x + region.x * pixel, place.y + region.y * pixel, region.width * pixel,
                 region.height * pixel];
    context.setLineDash([]);
    context.lineWidth = 3;
    context.strokeStyle = '#000000b0';
    context.strokeRect(...box);
    context.lineWidth = 1.5;
    context.setLineDash([5, 4]);
    context.strokeStyle = '#ffffff';
    context.strokeRect(...box);
    context.setLineDash([]);
  }

  drawEdge(box, x) {
    const {context} = this;
    if (x < box.x || x > box.x + box.width) return;
    context.fillStyle = '#00000080';
    context.fillRect(x - 1.5, box.y, 3, box.height);
    context.fillStyle = '#ffffff';
    context.fillRect(x - 0.5, box.y, 1, box.height);
    context.beginPath();
    context.arc(x, box.y + box.height / 2, 7, 0, 2 * Math.PI);
    context.fill();
    context.fillStyle = '#1d2126';
    context.font = '10px sans-serif';
    context.textAlign = 'center';
    context.textBaseline = 'middle';
    context.fillText('↔', x, box.y + box.height / 2 + 0.5);
  }
}

// A colour bar with ticks and unit, as an element.
function colorBarElement(mode) {
  const width = 264;
  const left = 26;
  const bar = makeElement('canvas', {width: 256, height: 1, class: 'colors'});
  const context = bar.getContext('2d');
  const colors = context.createImageData(256, 1);
  colors.data.set(colorTables[mode.table]);
  context.putImageData(colors, 0, 0);
  const element = makeElement('div', {class: 'scale'}, bar);
  for (const value of scaleTicks(mode.scale, mode.table === 'signed')) {
    const at = left + width * scalePosition(value, mode.scale, mode.table === 'signed');
    const text = Number(value.toPrecision(3)).toString().replace('-', '−');
    element.append(makeElement('i', {style: `left:${at.toFixed(1)}px`, text}));
  }
  const unit = [mode.scale.unit, mode.scale.logarithmic ? 'logarithmic' : ''].filter(Boolean);
  element.append(makeElement('span', {text: unit.join(', ')}));
  return element;
}

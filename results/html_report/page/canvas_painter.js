// ---- 2D canvas: what GlPainter does, for browsers without WebGL2.

// Colours of a job, into the bytes of an ImageData. The same steps as the display shader.
function shadeImage(job, bytes) {
  const {test, reference, tone} = job;
  const table = colorTables[job.table];
  const count = test.width * test.height;
  const {channels, halfs} = test;
  for (let i = 0, at = 0; i < count; ++i, at += 4) {
    bytes[at + 3] = 255;
    let isFinitePixel = true;
    for (let c = 0; c < channels; ++c) {
      if (!isFiniteHalf(halfs[i * channels + c])) isFinitePixel = false;
      if (reference && !isFiniteHalf(reference.halfs[i * channels + c])) isFinitePixel = false;
    }
    if (!isFinitePixel) {
      [bytes[at], bytes[at + 1], bytes[at + 2]] = kNonFiniteColor;
    } else if (job.kind === 'image') {
      for (let c = 0; c < 3; ++c) {
        bytes[at + c] = tone[halfs[i * channels + (channels === 3 ? c : 0)]];
      }
    } else {
      const value = job.kind === 'map' ? halfValues[halfs[i * channels]] * test.scale
                                       : differenceAt(job, i);
      const color = 4 * Math.floor(scalePosition(value, job.scale, job.kind === 'signed') * 255 + 0.5);
      bytes[at] = table[color];
      bytes[at + 1] = table[color + 1];
      bytes[at + 2] = table[color + 2];
    }
  }
}

function differenceAt({kind, test, reference}, index) {
  const x = [];
  const r = [];
  for (let c = 0; c < test.channels; ++c) {
    x.push(halfValues[test.halfs[index * test.channels + c]] * test.scale);
    r.push(halfValues[reference.halfs[index * test.channels + c]] * reference.scale);
  }
  return differenceOf(kind, x, r);
}

class CanvasPainter {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext('2d');
    this.name = '2D canvas';
    this.displayRuns = 0;
  }

  makeDisplay(job) {
    ++this.displayRuns;
    const {width, height} = job.test;
    const canvas = makeElement('canvas', {width, height});
    const context = canvas.getContext('2d');
    const data = context.createImageData(width, height);
    shadeImage(job, data.data);
    context.putImageData(data, 0, 0);
    return {source: canvas, width, height, bytes: 4 * width * height};
  }

  pictureDisplay(element) {
    return {source: element, width: element.naturalWidth, height: element.naturalHeight, bytes: 0};
  }

  dropDisplay() {}

  begin(width, height) {
    if (this.canvas.width !== width) this.canvas.width = width;
    if (this.canvas.height !== height) this.canvas.height = height;
    this.context.fillStyle = '#101214';
    this.context.fillRect(0, 0, width, height);
  }

  draw(display, place, clip, isSmooth) {
    const {context} = this;
    context.save();
    context.beginPath();
    context.rect(clip.x, clip.y, clip.width, clip.height);
    context.clip();
    context.imageSmoothingEnabled = isSmooth || place.width < display.width;
    context.imageSmoothingQuality = 'medium';
    context.drawImage(display.source, place.x, place.y, place.width, place.height);
    context.restore();
  }
}

// ---- What a pane has to show: floats once they are decoded, until then the 8-bit preview.

class Displays {
  constructor(painter, onChange) {
    this.painter = painter;
    this.onChange = onChange;  // called when something that was awaited is there
    this.kept = new Map();     // displays by what they depend on
    this.bytes = 0;
    this.mostBytes = 256 * 2 ** 20;
    this.awaited = new Set();
    this.tone = {key: '', bytes: null};
  }

  // {display, note, isPreview, test, reference, mode} for an image in a mode. `display` is null
  // while there is nothing to show, `note` says why what is asked for is not what is shown.
  of(state, imageIndex, modeKey) {
    const {scene, frame} = state;
    const image = scene.images[imageIndex];
    const mode = scene.mode(modeKey);
    if (mode.isMap) return this.ofMap(state, imageIndex, mode);
    const test = this.floats(image.floatsAt(frame));
    if (test.note || !mode.isDifference) return this.ofImage(state, image, test, '');
    const other = scene.images[state.other];
    const reference = this.floats(other.floatsAt(frame));
    if (!test.image || !reference.image) {
      return this.ofImage(state, image, test, reference.note || 'reading the floats …');
    }
    if (test.image.width !== reference.image.width ||
        test.image.height !== reference.image.height ||
        test.image.channels !== reference.image.channels) {
      return this.ofImage(state, image, test, 'no difference: the sizes differ, ' +
          `${image.width} × ${image.height} and ${other.width} × ${other.height}`);
    }
    const job = {kind: mode.key, test: test.image, reference: reference.image, scale: mode.scale,
                 table: mode.table};
    const key = [mode.key, image.floatsAt(frame).id, other.floatsAt(frame).id].join();
    return {...this.made(key, job), mode, test: test.image, reference: reference.image, note: ''};
  }

  ofImage(state, image, {image: test, note}, reason) {
    const mode = state.scene.modes[0];
    const why = reason || note;
    if (!test) {
      const isShown = image.isFirstFrame(state.frame);
      return {...this.preview(isShown ? image.preview : null), mode, note: why, isPreview: true};
    }
    const tone = this.toneOf(test, state);
    const key = ['image', image.floatsAt(state.frame).id, state.exposure, state.curve].join();
    return {...this.made(key, {kind: 'image', test, tone}), mode, test, note: why};
  }

  ofMap(state, imageIndex, mode) {
    const image = state.scene.images[imageIndex];
    const map = state.scene.map(imageIndex, mode);
    if (!map) {
      const test = this.floats(image.floatsAt(state.frame));
      return this.ofImage(state, image, test, `no map ${mode.name} of this image`);
    }
    const floats = map.floatsAt(state.frame);
    const test = floats ? this.floats(floats) : {};
    const isOtherFrame = state.scene.frames.length > 0 && !map.isOf(state.frame);
    const note = isOtherFrame ? `the map is of frame ${map.frame}` : test.note || '';
    if (!test.image) {
      const isShown = isOtherFrame || state.scene.frames.length === 0 || state.frame === map.frame;
      return {...this.preview(isShown ? map.preview : null), mode, note, isPreview: true};
    }
    const job = {kind: 'map', test: test.image, scale: map.scale, table: 'map'};
    return {...this.made(['map', floats.id].join(), job), mode, test: test.image, note};
  }

  // The decoded image, or a reason why there is none (yet: "").
  floats(description) {
    if (!description) return {image: null, note: 'no floats of this image'};
    const image = floatCache.peek(description);
    if (image) return {image, note: ''};
    const failure = floatCache.failure(description);
    if (failure) return {image: null, note: failure};
    if (!this.awaited.has(description.id)) {
      this.awaited.add(description.id);
      floatCache.load(description).then(() => {
        this.awaited.delete(description.id);
        this.onChange();
      });
    }
    return {image: null, note: ''};
  }

  // The byte that every half-float of an image becomes.
  toneOf(image, {exposure, curve}) {
    const key = [image.scale, exposure, curve].join();
    if (this.tone.key === key) return this.tone.bytes;
    const bytes = new Uint8Array(65536);
    const gain = image.scale * 2 ** exposure;
    for (let bits = 0; bits < 65536; ++bits) {
      if (isFiniteHalf(bits)) bytes[bits] = toneByte(halfValues[bits] * gain, curve);
    }
    this.tone = {key, bytes};
    return bytes;
  }

  made(key, job) {
    return {display: this.keep(key, () => this.painter.makeDisplay(job))};
  }

  preview(element) {
    if (!element) return {display: null};
    if (!element.complete || element.naturalWidth === 0) {
      element.addEventListener('load', () => this.onChange(), {once: true});
      return {display: null};
    }
    return {display: this.keep(element, () => this.painter.pictureDisplay(element))};
  }

  // Displays are kept by key; the least recently used go when they are too many.
  keep(key, make) {
    let display = this.kept.get(key);
    if (display === undefined) {
      display = make();
      if (display) this.bytes += display.bytes;
    }
    this.kept.delete(key);
    this.kept.set(key, display);
    for (const [oldest, old] of this.kept) {
      if (this.bytes <= this.mostBytes || this.kept.size <= 8) break;
      this.kept.delete(oldest);
      if (old) {
        this.bytes -= old.bytes;
        this.painter.dropDisplay(old);
      }
    }
    return display;
  }
}

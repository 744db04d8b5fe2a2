// ---- The viewer: images of one scene in one place, in one, two or four linked panes.

const kBlinkMs = 600;  // slow enough for people who must not see flicker
const kPlayMs = 1000 / 12;
const kLinkMs = 300;

function rightOf(box, edge) {
  const x = clamp(edge, box.x, box.x + box.width);
  return {...box, x, width: box.x + box.width - x};
}

class Viewer {
  constructor() {
    this.state = null;
    this.hold = false;
    this.blinkShowsOther = false;
    this.pointer = null;  // pixel of the scene under it
    this.drawCount = 0;
    this.controls = new Controls(this);
    this.dialog = this.controls.dialog;
    this.stage = this.controls.stage;
    this.overlay = new Overlay(this.controls.overlay);
    this.inspector = new Inspector(this.controls.inspector, this);
    this.message = '';
    this.heads = [0, 1, 2, 3].map(() => this.makeHead());
    new PointerInput(this);
    this.dialog.addEventListener('close', () => this.onClose());
    new ResizeObserver(() => this.redraw()).observe(this.stage);
  }

  // Only once something is to be painted: pages are read more often than images are looked at.
  usePainter() {
    try {
      this.painter = new GlPainter(this.controls.pixels);
      this.controls.pixels.addEventListener('webglcontextlost', event => {
        event.preventDefault();
        this.useCanvas('WebGL2 was lost');
      });
    } catch (error) {
      this.useCanvas(error.message);
      return;
    }
    this.displays = new Displays(this.painter, () => this.redraw());
  }

  useCanvas(reason) {
    this.controls.replacePixels();
    this.painter = new CanvasPainter(this.controls.pixels);
    this.displays = new Displays(this.painter, () => this.redraw());
    this.message = `${reason}: drawn by a 2D canvas`;
    this.redraw();
  }

  makeHead() {
    const head = makeElement('div', {class: 'head'});
    const bar = makeElement('div', {class: 'bar-of-pane'});
    this.controls.labels.append(head, bar);
    return {head, bar, mode: null};
  }

  open({scene, image, mode}) {
    this.show(newState(scene, image, mode));
    this.fit();
  }

  show(state) {
    this.state = state;
    this.stopMoving();
    if (!this.painter) this.usePainter();
    if (!this.dialog.open) this.dialog.showModal();
    this.stage.focus();
    this.controls.onScene(state);
    this.redraw();
  }

  close() { this.dialog.close(); }

  onClose() {
    if (this.dialog.open) return;  // opened again before it was told
    this.stopMoving();
    clearTimeout(this.linkTimer);
    this.state = null;
    history.replaceState(null, '', location.pathname + location.search);
  }

  stopMoving() {
    clearInterval(this.blinkTimer);
    clearInterval(this.playTimer);
    this.blinkTimer = this.playTimer = undefined;
    this.hold = this.blinkShowsOther = false;
  }

  // ---- Changes. Each keeps the state valid and draws.
  change(values) {
    Object.assign(this.state, values);
    this.redraw();
  }

  get pane() { return this.state.panes[this.state.active]; }

  select(index) {
    if (index < 0 || index >= this.state.scene.images.length) return;
    this.pane.image = index;
    this.redraw();
  }

  step(by) {
    const count = this.state.scene.images.length;
    this.select((this.pane.image + by + count) % count);
  }

  compareWith(index) {
    if (index >= 0 && index < this.state.scene.images.length) this.change({other: index});
  }

  setMode(key) {
    this.pane.mode = this.state.scene.mode(key).key;
    this.redraw();
  }

  stepMode(by) {
    const {modes} = this.state.scene;
    const at = modes.findIndex(mode => mode.key === this.pane.mode);
    this.setMode(modes[(at + by + modes.length) % modes.length].key);
  }

  // What was fitted stays so.
  setViews(views) {
    const isFitted = Math.abs(this.state.zoom / this.fitZoom() - 1) < 1e-6;
    this.change({views, active: Math.min(this.state.active, views - 1)});
    if (isFitted) this.fit();
  }

  stepOf(list, value) { return list[(list.indexOf(value) + 1) % list.length]; }

  exposeBy(stops) { this.change({exposure: clamp(this.state.exposure + stops, -30, 30)}); }

  toggleBlink() {
    if (this.blinkTimer === undefined) {
      this.blinkTimer = setInterval(() => {
        this.blinkShowsOther = !this.blinkShowsOther;
        this.redraw();
      }, kBlinkMs);
    } else {
      clearInterval(this.blinkTimer);
      this.blinkTimer = undefined;
      this.blinkShowsOther = false;
    }
    this.redraw();
  }

  // ---- Frames of a sequence.
  stepFrame(by) {
    const {frames} = this.state.scene;
    if (frames.length === 0) return;
    const at = frames.indexOf(this.state.frame);
    this.change({frame: frames[(at + by + frames.length) % frames.length]});
  }

  togglePlay() {
    if (this.playTimer !== undefined) {
      clearInterval(this.playTimer);
      this.playTimer = undefined;
    } else if (this.state.scene.frames.length > 1) {
      this.playTimer = setInterval(() => this.playOn(), kPlayMs);
    }
    this.redraw();
  }

  // The next frame, once the floats of all panes are there; the ones after it are asked for.
  playOn() {
    const {frames} = this.state.scene;
    const at = frames.indexOf(this.state.frame);
    const {scene} = this.state;
    const needed = new Set([scene.images[this.state.other]]);
    for (const pane of this.state.panes.slice(0, this.state.views)) {
      const mode = scene.mode(pane.mode);
      const map = mode.isMap ? scene.map(pane.image, mode) : null;
      needed.add(map || scene.images[pane.image]);
    }
    let isReady = true;
    for (let ahead = 1; ahead <= 3; ++ahead) {
      const frame = frames[(at + ahead) % frames.length];
      for (const shown of needed) {
        const floats = shown.floatsAt(frame);
        if (!floats || floatCache.failure(floats) || floatCache.peek(floats)) continue;
        floatCache.load(floats);
        if (ahead === 1) isReady = false;
      }
    }
    if (isReady) this.stepFrame(1);
  }

  // ---- Place and zoom.
  paneBoxes() {
    const {width, height} = this.stage.getBoundingClientRect();
    const isWide = width >= height;
    const across = this.state.views === 4 || (this.state.views === 2 && isWide) ? 2 : 1;
    const down = this.state.views / across;
    const gap = 2;
    const w = (width - gap * (across - 1)) / across;
    const h = (height - gap * (down - 1)) / down;
    return Array.from({length: this.state.views}, (_, i) => ({
      x: (i % across) * (w + gap), y: Math.floor(i / across) * (h + gap), width: w, height: h,
    }));
  }

  placeIn(box) {
    const {x, y, zoom, scene} = this.state;
    return {x: box.x + box.width / 2 - x * zoom, y: box.y + box.height / 2 - y * zoom,
            width: scene.width * zoom, height: scene.height * zoom};
  }

  fitZoom() {
    const {scene} = this.state;
    const [box] = this.paneBoxes();
    return clamp(Math.min(box.width / scene.width, box.height / scene.height), ...kZoomRange);
  }

  fit() {
    const {scene} = this.state;
    this.change({zoom: this.fitZoom(), x: scene.width / 2, y: scene.height / 2});
  }

  showRealSize() { this.change({zoom: 1 / window.devicePixelRatio}); }

  // The point of the image that is at (atX, atY) of the pane's middle stays there.
  zoomBy(factor, atX = 0, atY = 0) {
    const zoom = clamp(this.state.zoom * factor, ...kZoomRange);
    this.change({zoom, x: this.state.x + atX / this.state.zoom - atX / zoom,
                 y: this.state.y + atY / this.state.zoom - atY / zoom});
  }

  moveBy(dx, dy) {
    const {scene, zoom} = this.state;
    this.change({x: clamp(this.state.x - dx / zoom, 0, scene.width),
                 y: clamp(this.state.y - dy / zoom, 0, scene.height)});
  }

  // ---- Drawing.
  redraw() {
    if (this.drawing || !this.state) return;
    this.drawing = requestAnimationFrame(() => {
      this.drawing = undefined;
      if (!this.state) return;
      try {
        this.draw();
      } catch (error) {
        if (this.painter instanceof CanvasPainter) throw error;
        this.useCanvas(error.message);
      }
    });
  }

  draw() {
    ++this.drawCount;
    const ratio = window.devicePixelRatio;
    const {width, height} = this.stage.getBoundingClientRect();
    const size = [Math.max(1, Math.round(width * ratio)), Math.max(1, Math.round(height * ratio))];
    this.painter.begin(...size);
    this.overlay.begin(...size, ratio);
    const boxes = this.paneBoxes();
    boxes.forEach((box, i) => this.drawPane(box, i, ratio));
    for (let i = boxes.length; i < this.heads.length; ++i) {
      this.heads[i].head.hidden = this.heads[i].bar.hidden = true;
    }
    this.controls.update(this.state);
    if (!this.isDragging) this.inspector.update(this.state, this.pointer);
    clearTimeout(this.linkTimer);
    this.linkTimer = setTimeout(() => this.writeLink(), kLinkMs);
  }

  drawPane(box, index, ratio) {
    const {state} = this;
    const place = this.placeIn(box);
    const showsOther = this.hold || this.blinkShowsOther;
    const {image, mode} = state.panes[index];
    const other = showsOther || state.wipe ? this.displays.of(state, state.other, 'image') : null;
    const shown = showsOther ? other : this.displays.of(state, image, mode);
    const edge = place.x + place.width * state.wipeAt;
    const parts = state.wipe && !showsOther
        ? [{shown: other, clip: {...box, width: clamp(edge - box.x, 0, box.width)}},
           {shown, clip: rightOf(box, edge)}]
        : [{shown, clip: box}];
    for (const part of parts) {
      this.paint(part.shown, place, part.clip, ratio);
      this.overlay.drawPane({box: part.clip, place, shown: part.shown}, state, this.displays);
    }
    if (parts.length > 1) this.overlay.drawEdge(box, edge);
    this.updateHead(index, {box, shown}, showsOther ? state.other : image);
  }

  paint(shown, place, clip, ratio) {
    if (!shown.display || clip.width <= 0) return;
    const scaled = box => ({x: box.x * ratio, y: box.y * ratio, width: box.width * ratio,
                            height: box.height * ratio});
    this.painter.draw(shown.display, scaled(place), scaled(clip), this.state.filter === 'linear');
  }

  updateHead(index, {box, shown}, imageIndex) {
    const {state} = this;
    const {head, bar} = this.heads[index];
    const image = state.scene.images[imageIndex];
    head.hidden = false;
    head.style.cssText = `left:${box.x}px;top:${box.y}px;max-width:${box.width}px`;
    head.classList.toggle('active', state.views > 1 && index === state.active);
    const parts = [makeElement('b', {text: `${imageIndex + 1}  ${image.label}`})];
    if (shown.mode.key !== 'image') parts.push(makeElement('span', {text: shown.mode.name}));
    if (state.wipe) {
      parts.push(makeElement('span', {text: `left: ${state.scene.images[state.other].label}`}));
    }
    const bad = (shown.test?.nonFinite || 0) + (shown.reference?.nonFinite || 0);
    if (bad > 0) {
      const pixels = bad === 1 ? 'pixel is' : 'pixels are';
      parts.push(makeElement('em', {text: `${bad} ${pixels} not finite`}));
    }
    if (shown.note) parts.push(makeElement('span', {class: 'why', text: shown.note}));
    if (shown.isPreview) {
      parts.push(makeElement('span', {text: '8-bit preview'}));
    }
    head.replaceChildren(...parts);
    bar.hidden = !shown.mode.scale;
    bar.style.cssText = `left:${box.x + 8}px;top:${box.y + box.height - 58}px`;
    if (this.heads[index].mode !== shown.mode) {
      this.heads[index].mode = shown.mode;
      bar.replaceChildren(...(shown.mode.scale ? [colorBarElement(shown.mode)] : []));
    }
  }

  writeLink() {
    if (this.state && this.state.scene.hasFloats) history.replaceState(null, '', linkOf(this.state));
  }
}

// ---- Pointer and keys.

const kEdgeReachPx = 14;

class PointerInput {
  constructor(viewer) {
    this.viewer = viewer;
    this.stage = viewer.stage;
    this.stage.addEventListener('wheel', event => this.onWheel(event), {passive: false});
    this.stage.addEventListener('pointerdown', event => this.onDown(event));
    this.stage.addEventListener('pointermove', event => this.onMove(event));
    this.stage.addEventListener('pointerleave', () => this.onLeave());
  }

  // Where an event is: its pane, and the place in pixels of the scene.
  locate(event) {
    const {viewer} = this;
    const {left, top} = this.stage.getBoundingClientRect();
    const x = event.clientX - left;
    const y = event.clientY - top;
    const boxes = viewer.paneBoxes();
    const found = boxes.findIndex(
        box => x >= box.x && x < box.x + box.width && y >= box.y && y < box.y + box.height);
    const index = Math.max(0, found);
    const box = boxes[index];
    const place = viewer.placeIn(box);
    const {zoom} = viewer.state;
    return {index, box, place, x, y, pixelX: (x - place.x) / zoom, pixelY: (y - place.y) / zoom};
  }

  onWheel(event) {
    if (!this.viewer.state) return;
    event.preventDefault();
    const {box, x, y} = this.locate(event);
    const lines = event.deltaMode === 1 ? 30 : 1;
    this.viewer.zoomBy(Math.exp(-0.0015 * lines * event.deltaY), x - box.x - box.width / 2,
                       y - box.y - box.height / 2);
    this.onMove(event);
  }

  onMove(event) {
    const {viewer} = this;
    if (!viewer.state || viewer.isDragging) return;
    const {pixelX, pixelY} = this.locate(event);
    const {scene} = viewer.state;
    const isInside = pixelX >= 0 && pixelY >= 0 && pixelX < scene.width && pixelY < scene.height;
    const pointer = isInside ? {x: Math.floor(pixelX), y: Math.floor(pixelY)} : null;
    if (pointer?.x === viewer.pointer?.x && pointer?.y === viewer.pointer?.y) return;
    viewer.pointer = pointer;
    if (viewer.inspector.isShown) viewer.inspector.update(viewer.state, pointer);
  }

  onLeave() {
    this.viewer.pointer = null;
    this.viewer.redraw();
  }

  // A drag with shift draws a region; near the wipe's edge it moves the edge, elsewhere the image.
  onDown(event) {
    const {viewer} = this;
    if (event.button !== 0) return;
    event.preventDefault();
    this.stage.focus();
    const start = this.locate(event);
    if (start.index !== viewer.state.active) viewer.change({active: start.index});
    const {state} = viewer;
    const edge = start.place.x + start.place.width * state.wipeAt;
    if (event.shiftKey) {
      this.drag(event, next => this.drawRegion(start, next), () => viewer.redraw());
    } else if (state.wipe && Math.abs(start.x - edge) < kEdgeReachPx) {
      this.drag(event, next => viewer.change({
        wipeAt: clamp((this.locate(next).x - start.place.x) / start.place.width, 0, 1)}));
    } else {
      let last = event;
      this.drag(event, next => {
        viewer.moveBy(next.clientX - last.clientX, next.clientY - last.clientY);
        last = next;
      });
    }
  }

  drawRegion(start, event) {
    const end = this.locate(event);
    const x = Math.min(start.pixelX, end.pixelX);
    const y = Math.min(start.pixelY, end.pixelY);
    const region = regionWithin({x: Math.floor(x), y: Math.floor(y),
      width: Math.max(start.pixelX, end.pixelX) - Math.floor(x),
      height: Math.max(start.pixelY, end.pixelY) - Math.floor(y)}, this.viewer.state.scene);
    this.viewer.change({region});
    if (region && !this.viewer.inspector.isShown) this.viewer.controls.toggleInspector();
  }

  drag(event, onMove, onEnd = () => {}) {
    const {viewer, stage} = this;
    viewer.isDragging = true;
    const end = () => {
      viewer.isDragging = false;
      stage.removeEventListener('pointermove', onMove);
      for (const name of ['pointerup', 'pointercancel']) stage.removeEventListener(name, end);
      onEnd();
      viewer.redraw();
    };
    stage.setPointerCapture(event.pointerId);
    stage.addEventListener('pointermove', onMove);
    for (const name of ['pointerup', 'pointercancel']) stage.addEventListener(name, end);
  }
}

// Keys of the viewer: [keys, what the help says, action].
function keyBindings(viewer) {
  const {controls} = viewer;
  const views = () => viewer.setViews(viewer.stepOf(kViewCounts, viewer.state.views));
  return [
    [['1 – 9'], 'show this image', null],
    [['Shift + 1 – 9'], 'compare with this image', null],
    [['ArrowRight', 'ArrowDown'], 'next image', () => viewer.step(1)],
    [['ArrowLeft', 'ArrowUp'], 'image before', () => viewer.step(-1)],
    [[' '], 'flip to the image that is compared with, while held', null],
    [['w'], 'wipe: compared image left of the edge', () => viewer.change({wipe: !viewer.state.wipe})],
    [['b'], 'blink between the two', () => viewer.toggleBlink()],
    [['d'], 'next mode: differences, then error maps', () => viewer.stepMode(1)],
    [['D'], 'mode before', () => viewer.stepMode(-1)],
    [['e'], 'brighter by half a stop', () => viewer.exposeBy(0.5)],
    [['E'], 'darker by half a stop', () => viewer.exposeBy(-0.5)],
    [['r'], 'exposure of the report',
     () => viewer.change({exposure: viewer.state.scene.exposure})],
    [['t'], 'next tone curve: sRGB, linear, Reinhard, ACES',
     () => viewer.change({curve: viewer.stepOf(kCurves, viewer.state.curve)})],
    [['v'], 'one, two or four linked views', views],
    [['p'], 'next view',
     () => viewer.change({active: (viewer.state.active + 1) % viewer.state.views})],
    [['n'], 'nearest or linear filter',
     () => viewer.change({filter: viewer.stepOf(kFilters, viewer.state.filter)})],
    [['+', '='], 'zoom in', () => viewer.zoomBy(Math.SQRT2)],
    [['-'], 'zoom out', () => viewer.zoomBy(Math.SQRT1_2)],
    [['f'], 'fit', () => viewer.fit()],
    [['o'], 'one image pixel per screen pixel', () => viewer.showRealSize()],
    [['i'], 'inspector: values of all images', () => controls.toggleInspector()],
    [['x'], 'no region', () => viewer.change({region: null})],
    [['.'], 'next frame', () => viewer.stepFrame(1)],
    [[','], 'frame before', () => viewer.stepFrame(-1)],
    [['k'], 'play or stop', () => viewer.togglePlay()],
    [['c'], 'copy a link to what is shown', () => controls.copyLink()],
    [['?'], 'this help', () => controls.toggleHelp()],
    [['Escape'], 'close', null],
  ];
}

const kPanKeys = {ArrowLeft: [60, 0], ArrowRight: [-60, 0], ArrowUp: [0, 60], ArrowDown: [0, -60]};

class KeyInput {
  constructor(viewer, bindings) {
    this.viewer = viewer;
    this.actions = new Map();
    for (const [keys, , action] of bindings) {
      for (const key of keys) if (action) this.actions.set(key, action);
    }
    viewer.dialog.addEventListener('keydown', event => this.onDown(event));
    viewer.dialog.addEventListener('keyup', event => this.onUp(event));
  }

  onDown(event) {
    const {viewer} = this;
    if (!viewer.state || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.target.matches?.('input, select')) return;
    // Shift changes what a digit key writes, not which key it is.
    const digit = /^Digit[1-9]$/.test(event.code) ? Number(event.code[5]) - 1 : -1;
    if (digit >= 0 && event.shiftKey) viewer.compareWith(digit);
    else if (/^[1-9]$/.test(event.key)) viewer.select(Number(event.key) - 1);
    else if (event.key === ' ') this.setHold(true);
    else if (event.shiftKey && kPanKeys[event.key]) viewer.moveBy(...kPanKeys[event.key]);
    else if (this.actions.has(event.key)) this.actions.get(event.key)();
    else return;
    event.preventDefault();
  }

  onUp(event) {
    if (event.key === ' ') this.setHold(false);
  }

  setHold(hold) {
    if (this.viewer.hold === hold) return;
    this.viewer.hold = hold;
    this.viewer.redraw();
  }
}

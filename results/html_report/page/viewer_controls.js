// ---- The viewer's dialog: stage, inspector, tool bar, help.

class Controls {
  constructor(viewer) {
    this.viewer = viewer;
    this.pixels = makeElement('canvas', {class: 'pixels'});
    this.overlay = makeElement('canvas', {class: 'overlay'});
    this.labels = makeElement('div', {class: 'labels'});
    this.stage = makeElement('div', {class: 'stage', tabindex: '0', autofocus: '',
                                     'aria-label': 'images'},
                             this.pixels, this.overlay, this.labels);
    this.inspector = makeElement('aside', {class: 'inspector', 'aria-label': 'numbers'});
    this.inspector.hidden = window.innerWidth < 1000;
    this.help = makeElement('div', {class: 'help', hidden: ''});
    this.toast = makeElement('div', {class: 'toast', role: 'status', hidden: ''});
    this.panel = makeElement('div', {class: 'panel', role: 'toolbar'});
    this.dialog = makeElement('dialog', {class: 'viewer'}, this.stage, this.inspector, this.panel,
                              this.help, this.toast);
    document.body.append(this.dialog);
    this.buildPanel();
    this.dialog.addEventListener('cancel', event => {
      if (this.help.hidden) return;
      event.preventDefault();
      this.toggleHelp();
    });
  }

  // After the viewer's own parts are there.
  bindKeys() {
    const bindings = keyBindings(this.viewer);
    new KeyInput(this.viewer, bindings);
    const names = {' ': 'Space', ArrowRight: '→', ArrowDown: '↓', ArrowLeft: '←', ArrowUp: '↑',
                   Escape: 'Esc'};
    const rows = bindings.map(([keys, text]) => makeElement('div', {}, makeElement(
        'dt', {}, ...keys.map(key => makeElement('kbd', {text: names[key] || key}))),
        makeElement('dd', {text})));
    const pointer = [['drag', 'move the image, or the edge of the wipe'],
                     ['Shift + drag', 'region: statistics of all images'],
                     ['wheel', 'zoom'], ['Shift + arrows', 'move the image']];
    rows.push(...pointer.map(([key, text]) => makeElement('div', {}, makeElement(
        'dt', {}, makeElement('kbd', {text: key})), makeElement('dd', {text}))));
    this.help.append(makeElement('h2', {text: 'Keys'}), makeElement('dl', {}, ...rows));
    this.help.addEventListener('click', () => this.toggleHelp());
  }

  // A canvas that once had WebGL has no 2D context.
  replacePixels() {
    const canvas = makeElement('canvas', {class: 'pixels'});
    this.pixels.replaceWith(canvas);
    this.pixels = canvas;
  }

  button(text, title, action) {
    return makeElement('button', {type: 'button', text, title, click: () => {
      action();
      this.stage.focus();
    }});
  }

  choice(label, onChange) {
    const select = makeElement('select', {'aria-label': label, title: label});
    select.addEventListener('change', () => {
      onChange(select.value);
      this.stage.focus();
    });
    return select;
  }

  slider(label, onInput, attributes) {
    const input = makeElement('input', {type: 'range', 'aria-label': label, ...attributes});
    input.addEventListener('input', () => onInput(Number(input.value)));
    input.addEventListener('change', () => this.stage.focus());
    return input;
  }

  buildPanel() {
    const {viewer} = this;
    this.name = makeElement('b', {class: 'name'});
    this.image = this.choice('image (1–9)', value => viewer.select(Number(value)));
    this.other = this.choice('compared with (Shift + 1–9)',
                             value => viewer.compareWith(Number(value)));
    this.mode = this.choice('mode (d)', value => viewer.setMode(value));
    this.curve = this.choice('tone curve (t)', curve => viewer.change({curve}));
    for (const curve of kCurves) this.curve.append(new Option(kCurveNames[curve], curve));
    this.exposure = this.slider('exposure (e, E)', exposure => viewer.change({exposure}),
                                {min: -10, max: 10, step: 0.25});
    this.exposureText = makeElement('output');
    this.views = kViewCounts.map(count => this.button(
        String(count), 'linked views (v)', () => viewer.setViews(count)));
    this.wipe = this.button('wipe', 'wipe (w)',
                            () => viewer.change({wipe: !viewer.state.wipe}));
    this.blink = this.button('blink', 'blink (b)', () => viewer.toggleBlink());
    this.filter = this.button('linear', 'linear filter (n)', () => viewer.change(
        {filter: viewer.stepOf(kFilters, viewer.state.filter)}));
    this.numbers = this.button('numbers', 'inspector (i)', () => this.toggleInspector());
    this.zoom = makeElement('output', {class: 'zoom'});
    this.frame = this.slider('frame (, .)', index => viewer.change(
        {frame: viewer.state.scene.frames[index]}), {min: 0, step: 1});
    this.frameText = makeElement('output');
    this.play = this.button('play', 'play (k)', () => viewer.togglePlay());
    this.message = makeElement('span', {class: 'message'});
    this.floatControls = this.group(this.exposure, this.exposureText, this.curve);
    this.frameControls = this.group(this.play, this.frame, this.frameText);
    this.panel.append(
        this.name, this.group(this.image, this.mode), this.group('vs', this.other),
        this.floatControls, this.group(...this.views), this.group(this.wipe, this.blink,
        this.filter), this.frameControls, this.group(
            this.button('fit', 'fit (f)', () => viewer.fit()),
            this.button('1:1', 'one image pixel per screen pixel (o)', () => viewer.showRealSize()),
            this.zoom),
        this.message, this.group(
            this.numbers, this.button('link', 'copy a link to this view (c)', () => this.copyLink()),
            this.button('?', 'keys (?)', () => this.toggleHelp()),
            this.button('close', 'close (Esc)', () => viewer.close())));
    this.panel.lastChild.classList.add('last');
  }

  group(...parts) { return makeElement('span', {class: 'group'}, ...parts); }

  onScene({scene}) {
    const options = () => scene.images.map(
        (image, i) => new Option(`${i + 1}  ${image.label}`, String(i)));
    this.image.replaceChildren(...options());
    this.other.replaceChildren(...options());
    this.mode.replaceChildren(...scene.modes.map(mode => new Option(mode.name, mode.key)));
    this.floatControls.hidden = this.mode.hidden = !scene.hasFloats;
    this.numbers.hidden = !scene.hasFloats;
    this.frameControls.hidden = scene.frames.length < 2;
    this.frame.max = Math.max(0, scene.frames.length - 1);
    this.name.textContent = scene.name;
  }

  update(state) {
    const pane = state.panes[state.active];
    const {viewer} = this;
    this.image.value = String(pane.image);
    this.mode.value = pane.mode;
    this.other.value = String(state.other);
    this.curve.value = state.curve;
    this.exposure.value = String(state.exposure);
    this.exposureText.textContent =
        `${state.exposure < 0 ? '−' : '+'}${Math.abs(state.exposure).toFixed(2)} EV`;
    this.views.forEach((button, i) => this.press(button, state.views === kViewCounts[i]));
    this.press(this.wipe, state.wipe);
    this.press(this.blink, viewer.blinkTimer !== undefined);
    this.press(this.filter, state.filter === 'linear');
    this.press(this.numbers, !this.inspector.hidden);
    this.press(this.play, viewer.playTimer !== undefined);
    this.frame.value = String(Math.max(0, state.scene.frames.indexOf(state.frame)));
    this.frameText.textContent = `frame ${state.frame}`;
    this.zoom.textContent = `${formatNumber(100 * state.zoom * window.devicePixelRatio, 3)} %`;
    this.message.textContent = viewer.message;
  }

  press(button, isPressed) { button.setAttribute('aria-pressed', String(isPressed)); }

  toggleInspector() {
    this.inspector.hidden = !this.inspector.hidden;
    this.viewer.redraw();
  }

  toggleHelp() { this.help.hidden = !this.help.hidden; }

  async copyLink() {
    this.viewer.writeLink();
    try {
      await navigator.clipboard.writeText(location.href);
      this.tell('The link is in the clipboard.');
    } catch {
      this.tell('The link is in the address bar.');
    }
  }

  tell(text) {
    this.toast.textContent = text;
    this.toast.hidden = false;
    clearTimeout(this.toastTimer);
    this.toastTimer = setTimeout(() => { this.toast.hidden = true; }, 2000);
  }
}

// ---- The inspector: values of every image under the pointer, statistics of every image in the
// region. It asks for the floats of all images of the scene, one after the other.

const kStatistics = ['mean', 'min', 'max', 'rmse', 'relmse'];
const kRelmseEpsilon = 0.01;
const kMostImages = 40;  // in the tables; the one shown and the one compared with are among them

// The region in pixels of an image that may have another size than the scene's first one.
function regionIn(image, region, scene) {
  const across = image.width / scene.width;
  const down = image.height / scene.height;
  return regionWithin({x: region.x * across, y: region.y * down, width: region.width * across,
                       height: region.height * down}, image);
}

// Over pixels and channels. Values that are not finite are left out and their pixels counted.
// Errors are null where the images differ in size.
function regionStatistics(image, reference, box) {
  const result = {mean: 0, min: Infinity, max: -Infinity, rmse: null, relmse: null, nonFinite: 0};
  const isComparable = reference && reference.width === image.width &&
      reference.height === image.height && reference.channels === image.channels;
  let count = 0, compared = 0, squares = 0, relative = 0;
  for (let y = box.y; y < box.y + box.height; ++y) {
    for (let x = box.x; x < box.x + box.width; ++x) {
      let isFinitePixel = true;
      for (let c = 0; c < image.channels; ++c) {
        const value = image.at(x, y, c);
        if (!Number.isFinite(value)) {
          isFinitePixel = false;
          continue;
        }
        result.mean += value;
        result.min = Math.min(result.min, value);
        result.max = Math.max(result.max, value);
        ++count;
        if (!isComparable) continue;
        const truth = reference.at(x, y, c);
        if (!Number.isFinite(truth)) continue;
        squares += (value - truth) ** 2;
        relative += (value - truth) ** 2 / (truth ** 2 + kRelmseEpsilon);
        ++compared;
      }
      if (!isFinitePixel) ++result.nonFinite;
    }
  }
  result.mean = count > 0 ? result.mean / count : NaN;
  if (count === 0) result.min = result.max = NaN;
  if (compared > 0) {
    result.rmse = Math.sqrt(squares / compared);
    result.relmse = relative / compared;
  }
  return result;
}

class Inspector {
  constructor(element, viewer) {
    this.element = element;
    this.viewer = viewer;
    this.title = makeElement('h2');
    this.values = makeElement('table', {class: 'values'});
    this.regionTitle = makeElement('h2');
    this.statistics = makeElement('table', {class: 'statistics'});
    this.notes = makeElement('div', {class: 'notes'});
    element.append(this.title, this.values, this.regionTitle, this.statistics, this.notes);
    this.regionKey = '';
    this.readKey = '';
  }

  get isShown() { return !this.element.hidden; }

  // Asks for what is not decoded yet, once per scene and frame: what the cache dropped again, or
  // what cannot be read, stays away.
  async readAll(state) {
    const {scene, frame} = state;
    const key = `${scene.key} ${frame}`;
    if (this.readKey === key) return;
    this.readKey = key;
    let isDone = true;
    for (const {image} of this.imagesOf(state)) {
      isDone = this.readKey === key && this.viewer.state !== null && this.isShown;
      if (!isDone) break;
      const description = image.floatsAt(frame);
      if (!description || floatCache.peek(description) || floatCache.failure(description)) continue;
      await floatCache.load(description);
      this.viewer.redraw();
    }
    if (!isDone && this.readKey === key) this.readKey = '';
  }

  imagesOf(state) {
    const isChosen = index => index < kMostImages || index === state.other ||
        index === state.panes[state.active].image;
    return state.scene.images.map((image, index) => ({image, index})).filter(
        ({index}) => isChosen(index)).map(({image, index}) => {
      const description = image.floatsAt(state.frame);
      return {image, index, floats: description ? floatCache.peek(description) : null};
    });
  }

  update(state, pointer) {
    if (!this.isShown || !state.scene.hasFloats) return;
    const images = this.imagesOf(state);
    this.readAll(state);
    this.updateValues(state, images, pointer);
    this.updateStatistics(state, images);
  }

  updateValues(state, images, pointer) {
    const mode = state.scene.mode(state.panes[state.active].mode);
    this.title.textContent = pointer ? `Pixel ${pointer.x}, ${pointer.y}` : 'Pixel';
    const head = ['', '', 'R', 'G', 'B', ...(mode.key === 'image' ? [] : [mode.name])];
    this.values.replaceChildren(this.headRow(head));
    for (const one of images) this.values.append(this.valueRow(state, one, mode, pointer));
    const left = state.scene.images.length - images.length;
    const more = left > 0 ? `${left} more images are not listed. ` : '';
    const unit = mode.formula ? `${mode.formula}; r: ${state.scene.images[state.other].label}` : '';
    this.notes.textContent = more + (pointer ? unit : 'Move the pointer over an image.');
  }

  headRow(titles) {
    return makeElement('thead', {}, makeElement(
        'tr', {}, ...titles.map(text => makeElement('th', {text}))));
  }

  valueRow(state, {image, index, floats}, mode, pointer) {
    const cells = [makeElement('td', {class: 'key', text: index < 9 ? String(index + 1) : ''}),
                   makeElement('th', {text: image.label, title: image.label})];
    const at = pointer && floats ? placeIn(floats, pointer, state.scene) : null;
    const pixel = at ? floats.pixel(at.x, at.y) : null;
    for (let c = 0; c < 3; ++c) {
      const text = pixel ? formatNumber(pixel[pixel.length === 3 ? c : 0]) : pointer ? '…' : '';
      cells.push(makeElement('td', {text, class: pixel && !Number.isFinite(pixel[pixel.length === 3
          ? c : 0]) ? 'bad' : null}));
    }
    if (mode.key !== 'image') {
      cells.push(makeElement('td', {text: this.modeValue(state, index, mode, floats, at)}));
    }
    const css = [index === state.panes[state.active].image ? 'current' : '',
                 index === state.other ? 'other' : ''].join(' ').trim();
    return makeElement('tr', {class: css || null, click: () => this.viewer.select(index)}, ...cells);
  }

  modeValue(state, index, mode, floats, at) {
    if (!at) return '';
    if (mode.isMap) {
      const map = state.scene.map(index, mode);
      const description = map?.floatsAt(state.frame);
      const values = description ? floatCache.peek(description) : null;
      if (description && !values) floatCache.load(description).then(() => this.viewer.redraw());
      return values ? formatNumber(values.at(at.x, at.y, 0)) : map ? '…' : '';
    }
    const description = state.scene.images[state.other].floatsAt(state.frame);
    const reference = description ? floatCache.peek(description) : null;
    if (!reference || reference.width !== floats.width || reference.height !== floats.height ||
        reference.channels !== floats.channels) return '';
    return formatNumber(differenceOf(mode.key, floats.pixel(at.x, at.y),
                                     reference.pixel(at.x, at.y)));
  }

  updateStatistics(state, images) {
    const {region} = state;
    this.regionTitle.hidden = this.statistics.hidden = !region;
    const key = region ? [linkOf({...state, x: 0, y: 0, zoom: 1}), images.map(
        one => one.floats ? 1 : 0)].join() : '';
    if (key === this.regionKey || !region) return;
    this.regionKey = key;
    this.regionTitle.textContent =
        `Region ${region.width} × ${region.height} at ${region.x}, ${region.y}`;
    this.statistics.replaceChildren(this.headRow(['', '', ...kStatistics]));
    const reference = images.find(one => one.index === state.other).floats;
    for (const one of images) this.statistics.append(this.statisticsRow(state, one, reference));
  }

  statisticsRow(state, {image, index, floats}, reference) {
    const cells = [makeElement('td', {class: 'key', text: index < 9 ? String(index + 1) : ''}),
                   makeElement('th', {text: image.label, title: image.label})];
    const box = floats ? regionIn(floats, state.region, state.scene) : null;
    const numbers = box ? regionStatistics(floats, reference, box) : null;
    for (const name of kStatistics) {
      const text = !numbers ? '…' : numbers[name] === null ? '' : formatNumber(numbers[name], 3);
      cells.push(makeElement('td', {text, 'data-name': name}));
    }
    if (numbers && numbers.nonFinite > 0) {
      cells[1].append(makeElement('small', {class: 'bad', text: `${numbers.nonFinite} not finite`}));
    }
    const css = index === state.other ? 'other' : null;
    return makeElement('tr', {class: css, click: () => this.viewer.select(index)}, ...cells);
  }
}

// The pixel of an image under a pixel of the scene's first image.
function placeIn(image, {x, y}, scene) {
  const place = {x: Math.floor((x + 0.5) * image.width / scene.width),
                 y: Math.floor((y + 0.5) * image.height / scene.height)};
  return place.x >= 0 && place.y >= 0 && place.x < image.width && place.y < image.height ? place
                                                                                         : null;
}

// ---- What there is to view: the scenes of the page, their images and the modes to show them in.

const manifest = (() => {
  const element = document.getElementById('viewer-data');
  return element ? JSON.parse(element.textContent) : {colors: [], differences: {}, scenes: []};
})();

const colorTables = {
  map: manifest.colors.length > 0 ? colorTable(manifest.colors) : null,
  signed: colorTable(kSignedAnchors),
};

// An image of a scene: its floats, frame by frame if it is a sequence, and the preview's element.
class ViewImage {
  constructor(entry, preview) {
    this.label = entry.label;
    this.role = entry.role;
    this.width = entry.width;
    this.height = entry.height;
    this.floats = entry.floats;
    this.frames = entry.frames || [];
    this.preview = preview;
  }

  // Description of the floats at a frame; images without frames are the same at all of them.
  floatsAt(frame) {
    if (this.frames.length === 0) return this.floats;
    const found = this.frames.find(one => one.frame === frame);
    return found ? found.floats : null;
  }

  isFirstFrame(frame) {
    return this.frames.length === 0 || this.floatsAt(frame)?.id === this.floats?.id;
  }
}

// An error map of an image: of one frame, or of all.
class ViewMap {
  constructor(entry, preview) {
    Object.assign(this, entry);  // image, metric, against, group, scale, frame, floats, frames
    this.preview = preview;
  }

  isOf(frame) { return frame === this.frame || this.frames.some(one => one.frame === frame); }

  // Description of the floats at a frame; where none were kept, those that there are.
  floatsAt(frame) {
    const found = this.frames.find(one => one.frame === frame);
    return found ? found.floats : this.floats;
  }
}

class ViewScene {
  constructor(key, name, images, maps, exposure) {
    this.key = key;
    this.name = name;
    this.images = images;
    this.maps = maps;
    this.exposure = exposure;
    this.hasFloats = images.some(image => image.floats);
    this.frames = [...new Set(images.flatMap(image => image.frames.map(one => one.frame)))];
    this.frames.sort((a, b) => a - b);
    this.modes = this.listModes();
  }

  get width() { return this.images[0].width; }
  get height() { return this.images[0].height; }

  listModes() {
    const modes = [{key: 'image', name: 'image'}];
    if (!this.hasFloats) return modes;
    for (const [key, difference] of Object.entries(kDifferences)) {
      modes.push({
        key, name: difference.name, formula: difference.formula, table: difference.table,
        scale: manifest.differences[key], isDifference: true,
      });
    }
    for (const map of this.maps) {
      const against = map.against === 'own = full' ? 'full' : map.against;
      const key = `${map.metric}/${against}`;
      if (modes.some(mode => mode.key === key)) continue;
      modes.push({key, name: `${map.metric} (${against})`, metric: map.metric, against,
                  table: 'map', scale: map.scale, isMap: true});
    }
    return modes;
  }

  mode(key) { return this.modes.find(mode => mode.key === key) || this.modes[0]; }

  // The error map of an image; undefined if none was kept.
  map(imageIndex, mode) {
    return this.maps.find(map => map.image === imageIndex && map.metric === mode.metric &&
        (map.against === mode.against || map.against === 'own = full'));
  }
}

function pictureElements() { return [...document.querySelectorAll('img.picture')]; }

const placeKey = (group, image, against) => [group, image, against ?? ''].join('|');

function sceneOfEntry(entry) {
  const elements = new Map(pictureElements().map(element => [
    placeKey(element.dataset.group, element.dataset.image, element.dataset.against), element]));
  const find = (...place) => elements.get(placeKey(...place));
  const images = entry.images.map(
      (image, index) => new ViewImage(image, find(entry.anchor, index)));
  const maps = entry.maps.map(
      map => new ViewMap(map, find(map.group, map.image, map.against)));
  return new ViewScene(entry.anchor, entry.name, images, maps, entry.exposure_ev);
}

// Pictures of a page without floats.
function sceneOfPictures(element) {
  const key = element.dataset.group || 'pictures';
  const group = pictureElements().filter(
      other => (other.dataset.group || 'pictures') === key);
  const images = group.map(picture => new ViewImage(
      {label: picture.alt, role: 'method', floats: null, width: picture.naturalWidth,
       height: picture.naturalHeight}, picture));
  return {scene: new ViewScene(key, '', images, [], 0), image: group.indexOf(element)};
}

const knownScenes = new Map();

function sceneByKey(key) {
  const entry = manifest.scenes.find(scene => scene.anchor === key);
  if (!entry || entry.images.length === 0) return null;
  if (!knownScenes.has(key)) knownScenes.set(key, sceneOfEntry(entry));
  return knownScenes.get(key);
}

// Scene, image and mode that a picture of the page stands for.
function placeOfPicture(element) {
  const group = element.dataset.group || '';
  const scene = sceneByKey(group.replace(/-map-\d+$/, ''));
  if (!scene || element.dataset.image === undefined) {
    return {...sceneOfPictures(element), mode: 'image'};
  }
  const image = Number(element.dataset.image);
  const map = scene.maps.find(candidate => candidate.preview === element);
  if (!map) return {scene, image, mode: 'image'};
  const against = map.against === 'own = full' ? 'full' : map.against;
  return {scene, image, mode: `${map.metric}/${against}`};
}

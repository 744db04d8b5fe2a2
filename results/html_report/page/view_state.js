// ---- The state of the viewer, and the link that restores it.

const kViewCounts = [1, 2, 4];
const kFilters = ['nearest', 'linear'];
const kZoomRange = [0.02, 256];

// Panes have an image and a mode each; all else is shared. Centre and region are in pixels of the
// scene's first image, zoom in CSS pixels per pixel of it.
function newState(scene, image, mode) {
  return {
    scene, panes: [0, 1, 2, 3].map(
        i => ({image: paneImage(scene, image, i), mode: i === 0 ? mode : 'image'})),
    active: 0, views: 1, other: 0, exposure: scene.exposure, curve: 'srgb', wipe: false,
    wipeAt: 0.5, zoom: 1, x: scene.width / 2, y: scene.height / 2, filter: 'nearest',
    frame: scene.frames[0] ?? 0, region: null,
  };
}

// The first pane shows what was asked for, the others the images around it.
function paneImage(scene, image, pane) {
  const others = scene.images.map((_, index) => index).filter(index => index !== image);
  return pane === 0 ? image : others[(pane - 1) % Math.max(1, others.length)] ?? image;
}

const short = value => String(Number(value.toPrecision(6)));

function linkOf(state) {
  const values = {
    view: state.scene.key,
    images: state.panes.slice(0, state.views).map(pane => pane.image).join(','),
    modes: state.panes.slice(0, state.views).map(pane => pane.mode).join('|'),
    active: state.active, other: state.other, ev: short(state.exposure), curve: state.curve,
    wipe: state.wipe ? short(state.wipeAt) : '', zoom: short(state.zoom), x: short(state.x),
    y: short(state.y), filter: state.filter, frame: state.frame,
    region: state.region
        ? [state.region.x, state.region.y, state.region.width, state.region.height].join(',') : '',
  };
  const parts = Object.entries(values).filter(([, value]) => value !== '');
  return '#' + parts.map(([key, value]) => `${key}=${encodeURIComponent(value)}`).join('&');
}

function valuesOfLink(hash) {
  const values = {};
  for (const part of hash.replace(/^#/, '').split('&')) {
    const equals = part.indexOf('=');
    if (equals < 0) continue;
    try {
      values[part.slice(0, equals)] = decodeURIComponent(part.slice(equals + 1));
    } catch {
      return {};  // cut in the middle of an escape
    }
  }
  return values;
}

function numberIn(text, low, high, fallback) {
  const number = Number(text);
  return text !== undefined && text !== '' && Number.isFinite(number) ? clamp(number, low, high)
                                                                      : fallback;
}

// Whatever the link says, the state is one that the viewer can show; null if it names no scene.
function stateOfLink(hash) {
  const values = valuesOfLink(hash);
  const scene = values.view ? sceneByKey(values.view) : null;
  if (!scene) return null;
  const last = scene.images.length - 1;
  const images = (values.images || '').split(',').map(text => Math.round(numberIn(text, 0, last, 0)));
  const modes = (values.modes || '').split('|').map(key => scene.mode(key).key);
  const state = newState(scene, images[0], modes[0]);
  state.views = kViewCounts.includes(images.length) ? images.length : 1;
  for (let i = 0; i < state.views; ++i) {
    state.panes[i] = {image: images[i], mode: modes[i] || 'image'};
  }
  state.active = Math.round(numberIn(values.active, 0, state.views - 1, 0));
  state.other = Math.round(numberIn(values.other, 0, last, 0));
  state.exposure = numberIn(values.ev, -30, 30, scene.exposure);
  if (kCurves.includes(values.curve)) state.curve = values.curve;
  state.wipe = values.wipe !== undefined;
  state.wipeAt = numberIn(values.wipe, 0, 1, 0.5);
  state.zoom = numberIn(values.zoom, ...kZoomRange, 1);
  state.x = numberIn(values.x, -scene.width, 2 * scene.width, scene.width / 2);
  state.y = numberIn(values.y, -scene.height, 2 * scene.height, scene.height / 2);
  if (kFilters.includes(values.filter)) state.filter = values.filter;
  const frame = numberIn(values.frame, -1e9, 1e9, state.frame);
  if (scene.frames.includes(frame)) state.frame = frame;
  state.region = regionOfText(values.region, scene);
  return state;
}

function regionOfText(text, scene) {
  const numbers = (text || '').split(',').map(Number);
  if (numbers.length !== 4 || !numbers.every(Number.isInteger)) return null;
  return regionWithin({x: numbers[0], y: numbers[1], width: numbers[2], height: numbers[3]}, scene);
}

// Whole pixels inside the scene's image; null if none is.
function regionWithin({x, y, width, height}, scene) {
  const left = clamp(Math.floor(x), 0, scene.width);
  const top = clamp(Math.floor(y), 0, scene.height);
  const right = clamp(Math.ceil(x + width), left, scene.width);
  const bottom = clamp(Math.ceil(y + height), top, scene.height);
  if (right === left || bottom === top) return null;
  return {x: left, y: top, width: right - left, height: bottom - top};
}

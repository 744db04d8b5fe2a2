'use strict';
// The page is complete without this script; it adds sorting, and a viewer for the images.

// ---- Tables: a click on a title sorts, a second one turns the order round.
function sortKey(row, column) {
  const cell = row.cells[column];
  const number = cell.dataset.sort;
  return number === undefined ? cell.textContent.trim() : Number(number);
}

// Numbers before words; words by their text, so that "n/a" and failures come last.
function compareKeys(a, b) {
  if (typeof a !== typeof b) return typeof a === 'number' ? -1 : 1;
  return typeof a === 'number' ? a - b : a.localeCompare(b);
}

function sortTable(table, column) {
  const titles = table.tHead.rows[0].cells;
  const direction = titles[column].getAttribute('aria-sort') === 'ascending' ? -1 : 1;
  const rows = [...table.tBodies[0].rows].map(row => ({row, key: sortKey(row, column)}));
  rows.sort((a, b) => typeof a.key === typeof b.key ? direction * compareKeys(a.key, b.key)
                                                    : compareKeys(a.key, b.key));
  table.tBodies[0].append(...rows.map(entry => entry.row));
  for (const title of titles) title.removeAttribute('aria-sort');
  titles[column].setAttribute('aria-sort', direction === 1 ? 'ascending' : 'descending');
}

for (const table of document.querySelectorAll('table.sortable')) {
  [...table.tHead.rows[0].cells].forEach((title, column) => {
    title.classList.add('sorts');
    title.tabIndex = 0;
    title.addEventListener('click', () => sortTable(table, column));
    title.addEventListener('keydown', event => {
      if (event.key === 'Enter') sortTable(table, column);
    });
  });
}

// ---- Printing shows what is folded away on the screen.
let foldedBeforePrint = [];
window.addEventListener('beforeprint', () => {
  foldedBeforePrint = [...document.querySelectorAll('details:not([open])')];
  for (const details of foldedBeforePrint) details.open = true;
});
window.addEventListener('afterprint', () => {
  for (const details of foldedBeforePrint) details.open = false;
});

// ---- Viewer: the images of one group in one place. Zoom and position stay when the image changes.
class Viewer {
  constructor() {
    this.dialog = document.createElement('dialog');
    this.dialog.className = 'viewer';
    this.dialog.innerHTML =
        '<div class="stage"><img class="under" alt=""><img class="over" alt="">' +
        '<div class="edge" hidden></div></div><div class="panel"><b class="name"></b>' +
        '<button class="wipe" aria-pressed="false">wipe (w)</button>' +
        '<button class="fit">fit (f)</button><button class="real">1:1 (o)</button>' +
        '<button class="close">close (Esc)</button><span class="hint">keys 1–9, arrows: ' +
        'other images · wheel: zoom · drag: move image or edge</span></div>';
    document.body.append(this.dialog);
    const part = name => this.dialog.querySelector('.' + name);
    [this.stage, this.under, this.over, this.edge, this.name, this.wipeButton] =
        ['stage', 'under', 'over', 'edge', 'name', 'wipe'].map(part);
    this.images = [];
    this.index = 0;
    this.scale = 1;
    this.offset = {x: 0, y: 0};
    this.wipe = false;
    this.wipeAt = 0.5;
    this.wipeButton.addEventListener('click', () => this.toggleWipe());
    part('fit').addEventListener('click', () => this.fit());
    part('real').addEventListener('click', () => this.showRealSize());
    part('close').addEventListener('click', () => this.dialog.close());
    this.dialog.addEventListener('keydown', event => this.onKey(event));
    this.stage.addEventListener('wheel', event => this.onWheel(event), {passive: false});
    this.stage.addEventListener('pointerdown', event => this.onPointerDown(event));
    window.addEventListener('resize', () => { if (this.dialog.open) this.fit(); });
  }

  open(image) {
    this.images = [...document.querySelectorAll('img.picture')].filter(
        other => other.dataset.group === image.dataset.group);
    this.index = this.images.indexOf(image);
    this.dialog.showModal();
    this.fit();
  }

  size() {
    const first = this.images[0];
    return {width: first.naturalWidth, height: first.naturalHeight};
  }

  fit() {
    const {width, height} = this.size();
    const box = this.stage.getBoundingClientRect();
    this.zoomTo(Math.min(box.width / width, box.height / height));
  }

  showRealSize() { this.zoomTo(1 / window.devicePixelRatio); }

  zoomTo(scale) {
    const {width, height} = this.size();
    const box = this.stage.getBoundingClientRect();
    this.scale = scale;
    this.offset = {x: (box.width - scale * width) / 2, y: (box.height - scale * height) / 2};
    this.draw();
  }

  select(index) {
    if (index < 0 || index >= this.images.length) return;
    this.index = index;
    this.draw();
  }

  toggleWipe() {
    this.wipe = !this.wipe;
    this.draw();
  }

  draw() {
    const shown = this.images[this.index];
    const {width, height} = this.size();
    // The first image of a group is the reference; it lies under the wipe.
    for (const [element, source] of [[this.under, this.images[0]], [this.over, shown]]) {
      if (element.src !== source.src) element.src = source.src;
      element.style.width = width + 'px';
      element.style.height = height + 'px';
      element.style.transform =
          `translate(${this.offset.x}px, ${this.offset.y}px) scale(${this.scale})`;
      element.style.imageRendering = this.scale >= 2 ? 'pixelated' : 'auto';
    }
    this.over.style.clipPath = this.wipe ? `inset(0 0 0 ${100 * this.wipeAt}%)` : 'none';
    this.edge.hidden = !this.wipe;
    this.edge.style.left = this.offset.x + this.scale * width * this.wipeAt + 'px';
    this.wipeButton.setAttribute('aria-pressed', String(this.wipe));
    const left = this.wipe ? this.images[0].alt + '  |  ' : '';
    this.name.textContent = `${this.index + 1}/${this.images.length}  ${left}${shown.alt}`;
  }

  onKey(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const count = this.images.length;
    const actions = {
      ArrowRight: () => this.select((this.index + 1) % count),
      ArrowLeft: () => this.select((this.index + count - 1) % count),
      ArrowDown: () => this.select((this.index + 1) % count),
      ArrowUp: () => this.select((this.index + count - 1) % count),
      w: () => this.toggleWipe(), f: () => this.fit(), o: () => this.showRealSize(),
    };
    if (/^[1-9]$/.test(event.key)) this.select(Number(event.key) - 1);
    else if (actions[event.key]) actions[event.key]();
    else return;
    event.preventDefault();
  }

  onWheel(event) {
    event.preventDefault();
    const box = this.stage.getBoundingClientRect();
    const x = event.clientX - box.left;
    const y = event.clientY - box.top;
    const factor = Math.exp(-0.0015 * event.deltaY);
    const scale = Math.min(64, Math.max(0.05, this.scale * factor));
    // The point under the pointer stays where it is.
    this.offset.x = x - (x - this.offset.x) * scale / this.scale;
    this.offset.y = y - (y - this.offset.y) * scale / this.scale;
    this.scale = scale;
    this.draw();
  }

  // A drag near the wipe's edge moves the edge, elsewhere the image.
  onPointerDown(event) {
    event.preventDefault();
    const left = this.stage.getBoundingClientRect().left;
    const width = this.scale * this.size().width;
    const edgeX = left + this.offset.x + width * this.wipeAt;
    const movesEdge = this.wipe && Math.abs(event.clientX - edgeX) < 24;
    let last = {x: event.clientX, y: event.clientY};
    const move = next => {
      if (movesEdge) {
        const at = (next.clientX - left - this.offset.x) / width;
        this.wipeAt = Math.min(1, Math.max(0, at));
      } else {
        this.offset.x += next.clientX - last.x;
        this.offset.y += next.clientY - last.y;
      }
      last = {x: next.clientX, y: next.clientY};
      this.draw();
    };
    const end = () => {
      this.stage.removeEventListener('pointermove', move);
      this.stage.removeEventListener('pointerup', end);
      this.stage.removeEventListener('pointercancel', end);
    };
    this.stage.setPointerCapture(event.pointerId);
    this.stage.addEventListener('pointermove', move);
    this.stage.addEventListener('pointerup', end);
    this.stage.addEventListener('pointercancel', end);
  }
}

const viewer = new Viewer();
for (const image of document.querySelectorAll('img.picture')) {
  image.classList.add('zooms');
  image.tabIndex = 0;
  image.addEventListener('click', () => viewer.open(image));
  image.addEventListener('keydown', event => {
    if (event.key === 'Enter') viewer.open(image);
  });
}

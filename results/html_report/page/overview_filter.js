// ---- The overview's filter: words, which a row or column has to have in its name, and states.

const kCellStates = [['ok', 'ok'], ['failed', 'failed'], ['open', 'not decided']];

class OverviewFilter {
  constructor(place, matrix, numbers) {
    this.matrix = matrix;
    this.numbers = numbers;
    this.words = makeElement('input', {
      type: 'search', placeholder: 'filter scenes and methods', 'aria-label': 'filter'});
    this.words.addEventListener('input', () => this.apply());
    this.boxes = kCellStates.filter(([state]) => matrix.querySelector(`[data-state="${state}"]`))
        .map(([state, text]) => this.box(state, text));
    if (this.boxes.length < 2) this.boxes = [];  // nothing to choose
    this.count = makeElement('output');
    place.classList.add('filter');
    place.append(this.words, ...this.boxes.map(({label}) => label), this.count);
    this.apply();
  }

  box(state, text) {
    const input = makeElement('input', {type: 'checkbox', checked: '', value: state});
    input.addEventListener('change', () => this.apply());
    return {state, input, label: makeElement('label', {}, input, text)};
  }

  // A cell stays if its row's and its column's name have all words together, and its state is one
  // of those that are ticked. A row or column without such a cell goes.
  apply() {
    const words = this.words.value.toLowerCase().split(/\s+/).filter(Boolean);
    const has = text => words.every(word => text.includes(word));
    const shown = new Set(this.boxes.filter(box => box.input.checked).map(box => box.state));
    const titles = [...this.matrix.tHead.rows[0].cells];
    const columns = new Set();
    let count = 0;
    for (const row of this.matrix.tBodies[0].rows) {
      let isWanted = false;
      for (let i = 1; i < row.cells.length; ++i) {
        const cell = row.cells[i];
        const name = `${row.cells[0].textContent} ${titles[i].textContent}`.toLowerCase();
        const fits = has(name) && (this.boxes.length === 0 || shown.has(cell.dataset.state));
        cell.classList.toggle('dimmed', !fits);
        if (!fits || !cell.dataset.state) continue;
        isWanted = true;
        columns.add(i);
        ++count;
      }
      row.classList.toggle('filtered', !isWanted);
    }
    this.showColumns(columns);
    for (const row of this.numbers ? this.numbers.tBodies[0].rows : []) {
      row.classList.toggle('filtered', !has(row.textContent.toLowerCase()));
    }
    const all = this.matrix.querySelectorAll('[data-state]').length;
    this.count.textContent = count === all ? '' : `${count} of ${all}`;
  }

  showColumns(columns) {
    for (const row of this.matrix.rows) {
      if (row.closest('table') !== this.matrix) continue;
      for (let i = 1; i < row.cells.length; ++i) {
        row.cells[i].classList.toggle('filtered', !columns.has(i));
      }
    }
  }
}

const filterPlace = document.getElementById('matrix-filter');
if (filterPlace && document.getElementById('matrix')) {
  new OverviewFilter(filterPlace, document.getElementById('matrix'),
                     document.getElementById('numbers'));
}

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


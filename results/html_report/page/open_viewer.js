// ---- Pictures of the page open the viewer; so does a link that was made by it.

const viewer = new Viewer();
viewer.controls.bindKeys();
window.discernViewer = viewer;  // for people who script the page, and for tests

for (const image of pictureElements()) {
  image.classList.add('zooms');
  image.tabIndex = 0;
  image.addEventListener('click', () => viewer.open(placeOfPicture(image)));
  image.addEventListener('keydown', event => {
    if (event.key === 'Enter') viewer.open(placeOfPicture(image));
  });
}

function followLink() {
  const state = stateOfLink(location.hash);
  if (state) viewer.show(state);
  else if (viewer.dialog.open) viewer.close();
}
window.addEventListener('hashchange', followLink);
followLink();
viewer.readyAt = performance.now();

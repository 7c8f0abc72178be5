'use strict';
// Before the page is drawn, so that it never flashes in the other scheme.
try {
  const chosen = localStorage.getItem('lapidary-theme');
  if (chosen) document.documentElement.dataset.theme = chosen;
} catch {
  // Without storage the system's scheme is followed.
}

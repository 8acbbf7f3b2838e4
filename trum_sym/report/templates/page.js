(() => {
  'use strict';
  const root = document.documentElement, contents = document.querySelector('nav details');
  if (matchMedia('(max-width: 60rem)').matches) contents.open = false;
  document.getElementById('theme').addEventListener('click', () => {
    const dark = root.dataset.theme ? root.dataset.theme === 'dark' : matchMedia('(prefers-color-scheme: dark)').matches;
    root.dataset.theme = dark ? 'light' : 'dark';
  });
  const wide = [...document.querySelectorAll('.wide')];
  const hint = () => wide.forEach(box => box.classList.toggle('scrolls', box.scrollWidth > box.clientWidth + 1));
  addEventListener('resize', hint);
  document.addEventListener('toggle', hint, true);
  hint();
  const stops = [...document.querySelectorAll('.stop')];
  document.addEventListener('keydown', event => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.closest('input, select, textarea')) return;
    const step = {j: 1, k: -1}[event.key];
    if (!step) return;
    const tops = stops.map(stop => stop.getBoundingClientRect().top);
    const next = step > 0 ? stops.find((_, i) => tops[i] > 24) : stops.findLast((_, i) => tops[i] < -8);
    if (next) { next.scrollIntoView(); next.focus({preventScroll: true}); }
  });
  const buttons = [...document.querySelectorAll('.filter button')], claims = [...document.querySelectorAll('.claim')];
  const show = verdict => {
    for (const button of buttons) button.setAttribute('aria-pressed', button.dataset.verdict === verdict);
    for (const claim of claims) claim.hidden = verdict !== 'all' && claim.dataset.verdict !== verdict;
  };
  for (const button of buttons) button.addEventListener('click', () => show(button.dataset.verdict));
  const reveal = () => {
    const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
    if (target && target.hidden) { show('all'); target.scrollIntoView(); }
  };
  addEventListener('hashchange', reveal);
  reveal();
})();

"""Style sheet of the Godot demo's page (godot_page.py), which loads nothing from elsewhere."""

STYLE = """
:root { --paper: #f6f4ef; --card: #ffffff; --ink: #23201c; --soft: #6d665c; --line: #e2dcd0;
  --accent: #b4561d; --best: #e9f3e4; --bad: #a3201f; color-scheme: light dark; }
@media (prefers-color-scheme: dark) { :root { --paper: #16171a; --card: #1f2125; --ink: #ece8e1;
  --soft: #a09a90; --line: #34373d; --accent: #f0a25f; --best: #26372a; --bad: #ff8a80; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink);
  font: 16px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, sans-serif; }
main, header { max-width: 1060px; margin: 0 auto; padding: 0 16px; }
header { padding-top: 32px; }
h1 { font-size: 2rem; line-height: 1.15; margin: 0 0 8px; letter-spacing: -0.01em; }
h2 { font-size: 1.35rem; margin: 0 0 12px; }
h3 { font-size: 1.02rem; margin: 24px 0 8px; }
p { margin: 0 0 12px; max-width: 70ch; }
.soft, figcaption { color: var(--soft); font-size: 0.86rem; }
section { background: var(--card); border: 1px solid var(--line); border-radius: 14px;
  padding: 18px; margin: 22px 0; }
nav { display: flex; flex-wrap: wrap; gap: 8px; margin: 14px 0 0; }
nav a { color: inherit; text-decoration: none; border: 1px solid var(--line); border-radius: 99px;
  padding: 4px 12px; background: var(--card); font-size: 0.9rem; }
nav a:hover, nav a:focus { border-color: var(--accent); }
.failure { color: var(--bad); overflow-wrap: anywhere; }
.compare { position: relative; aspect-ratio: var(--aspect); max-width: 640px; margin: 0 auto; border-radius: 10px;
  overflow: hidden; --x: 50%; touch-action: pan-y; }
.compare img { position: absolute; inset: 0; width: 100%; height: 100%; object-fit: cover; display: block; }
.compare img.over { clip-path: inset(0 0 0 var(--x)); }
.compare i { position: absolute; top: 0; bottom: 0; left: var(--x); width: 2px; background: #ffffffd0; }
.compare i::after { content: "\\2194"; position: absolute; top: 50%; left: 1px; transform: translate(-50%, -50%);
  background: #ffffffe8; color: #222; width: 32px; height: 32px; border-radius: 50%; display: grid;
  place-items: center; font-style: normal; box-shadow: 0 1px 5px #0006; }
.compare b { position: absolute; bottom: 8px; font-size: 0.78rem; font-weight: 600; color: #fff; background: #000a;
  padding: 2px 8px; border-radius: 99px; pointer-events: none; }
.compare b.left { left: 8px; } .compare b.right { right: 8px; }
.compare input { position: absolute; inset: 0; width: 100%; height: 100%; margin: 0; opacity: 0; cursor: ew-resize; }
.compare:focus-within { outline: 3px solid var(--accent); }
.strip { display: grid; grid-template-columns: repeat(3, 1fr); gap: 10px; }
.strip figure { margin: 0; }
.strip img { width: 100%; aspect-ratio: var(--aspect); display: block; border-radius: 8px; background: #0002;
  image-rendering: auto; }
.table { overflow-x: auto; margin: 12px -18px 0; padding: 0 18px; }
table { border-collapse: collapse; width: 100%; font-size: 0.9rem; font-variant-numeric: tabular-nums; }
p.soft { margin: 12px 0 0; }
th, td { padding: 6px 10px; text-align: right; white-space: nowrap; border-bottom: 1px solid var(--line); }
th { font-weight: 600; color: var(--soft); }
th:first-child, td:first-child { text-align: left; position: sticky; left: 0; background: var(--card); }
td.best { background: var(--best); font-weight: 600; }
th.text, td.text { text-align: left; }
td.failure { text-align: left; white-space: normal; min-width: 240px; }
button { all: unset; cursor: pointer; border-bottom: 1px dotted var(--soft); }
button:hover, button:focus-visible { color: var(--accent); border-color: var(--accent); }
button[aria-pressed="true"] { color: var(--accent); border-bottom: 2px solid var(--accent); font-weight: 600; }
svg { width: 100%; min-width: 540px; max-width: 860px; margin: 0 auto; height: auto; display: block; font: 13px system-ui, sans-serif; }
svg .axis { stroke: var(--line); } svg text { fill: var(--ink); } svg text.tick { fill: var(--soft); font-size: 12px; }
svg .halo { stroke: var(--card); stroke-width: 4px; paint-order: stroke; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 2px 16px; margin: 0; font-size: 0.9rem; }
dt { color: var(--soft); } dd { margin: 0; overflow-wrap: anywhere; }
@media (max-width: 560px) { section { padding: 14px; border-radius: 12px; } .table { margin: 12px -14px 0; padding: 0 14px; }
  .strip { gap: 6px; } th, td { padding: 6px 7px; } figcaption { font-size: 0.76rem; } h1 { font-size: 1.6rem; } }
"""

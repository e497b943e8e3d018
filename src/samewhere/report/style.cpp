#include <samewhere/report/style.hpp>

namespace samewhere::report {
namespace {

constexpr std::string_view kStyleSheet = R"css(
:root {
  color-scheme: light dark;
  --paper: #fbfaf8; --card: #ffffff; --ink: #22262a; --soft: #6a7076; --line: #e5e2dc;
  --path: #1d5f8a; --odometry: #c88a3a; --truth: #a3a39d; --loop: #2e8b68;
  --yes: #2e8b68; --no: #b8563f; --maybe: #b98a2f; --idle: #b9bcc0; --track: #7fa9c4;
  --resume: #8270b5; --bar: #dfe6ea;
}
@media (prefers-color-scheme: dark) {
  :root {
    --paper: #15181b; --card: #1c2024; --ink: #e7e5e0; --soft: #989ea5; --line: #2d3237;
    --path: #86bde0; --odometry: #d7a860; --truth: #6f757b; --loop: #68c4a0;
    --yes: #68c4a0; --no: #dd8b77; --maybe: #d9b25c; --idle: #565c63; --track: #4f7d9b;
    --resume: #a897d9; --bar: #2b3238;
  }
}
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; }
body {
  margin: 0; background: var(--paper); color: var(--ink);
  font: 16px/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif;
  font-variant-numeric: tabular-nums;
}
main { max-width: 62rem; margin: 0 auto; padding: 3.5rem 1.5rem 5rem; }
h1, h2 { font-weight: 600; letter-spacing: -0.012em; line-height: 1.2; margin: 0; }
h1 { font-size: 2.1rem; overflow-wrap: anywhere; }
h2 { font-size: 1.2rem; }
section { margin-top: 3.5rem; }
p { margin: 0.5rem 0 0; }
.source { color: var(--soft); overflow-wrap: anywhere; }
.lead { font-size: 1.1rem; max-width: 44rem; margin-top: 1.25rem; }
.note { color: var(--soft); font-size: 0.92rem; max-width: 46rem; }
.warning {
  margin-top: 1.25rem; padding: 0.7rem 1rem; border-left: 3px solid var(--maybe);
  background: var(--card);
}
.figures {
  display: grid; grid-template-columns: repeat(auto-fill, minmax(10.5rem, 1fr));
  gap: 1px; margin: 2.25rem 0 0; background: var(--card);
  border: 1px solid var(--line); border-radius: 10px; overflow: hidden;
}
.figures div {
  display: flex; flex-direction: column; justify-content: space-between;
  padding: 0.85rem 1rem; box-shadow: 0 0 0 1px var(--line);
}
.figures dt { color: var(--soft); font-size: 0.82rem; line-height: 1.35; }
.figures dd { margin: 0.2rem 0 0; font-size: 1.2rem; line-height: 1.3; overflow-wrap: anywhere; }
figure { margin: 0; }
.plot { margin-top: 1rem; background: var(--card); border: 1px solid var(--line); border-radius: 10px; }
.plot svg { display: block; width: 100%; height: auto; }
svg polyline { fill: none; stroke-linejoin: round; stroke-linecap: round; }
svg .truth { stroke: var(--truth); stroke-width: 1.6; stroke-dasharray: 5 5; }
svg .odometry { stroke: var(--odometry); stroke-width: 1.5; }
svg .path { stroke: var(--path); stroke-width: 3; }
svg .loop line { stroke: var(--loop); stroke-width: 2; }
svg .loop circle { fill: var(--card); stroke: var(--loop); stroke-width: 2; }
svg .mark { fill: var(--path); stroke: var(--card); stroke-width: 2; }
svg .mark.open { fill: var(--card); stroke: var(--path); stroke-width: 2.5; }
svg .bar { stroke: var(--soft); stroke-width: 1.5; }
svg text {
  fill: var(--soft); font-size: 14px; paint-order: stroke; stroke: var(--card); stroke-width: 4px;
}
.legend {
  display: flex; flex-wrap: wrap; gap: 0.35rem 1.4rem; margin: 0.8rem 0 0; padding: 0;
  list-style: none; font-size: 0.9rem; color: var(--soft);
}
.legend i {
  display: inline-block; width: 1.3rem; height: 0; margin-right: 0.5rem; vertical-align: 0.28em;
  border-top: 2px solid var(--soft);
}
.legend .path i { border-top: 3px solid var(--path); }
.legend .odometry i { border-color: var(--odometry); }
.legend .truth i { border-top: 2px dashed var(--truth); }
.legend .loop i { border-color: var(--loop); }
.strip { margin-top: 1rem; }
.strip svg { display: block; width: 100%; height: 22px; border-radius: 6px; }
.states i { width: 0.75rem; height: 0.75rem; border: 0; border-radius: 3px; vertical-align: -0.08em; }
.initializing { fill: var(--idle); background: var(--idle); }
.tracking { fill: var(--track); background: var(--track); }
.weak { fill: var(--maybe); background: var(--maybe); }
.lost { fill: var(--no); background: var(--no); }
.relocalized { fill: var(--resume); background: var(--resume); }
.provisional { fill: var(--resume); background: var(--resume); opacity: 0.5; }
.waiting { fill: var(--bar); background: var(--bar); }
.legend li.initializing, .legend li.tracking, .legend li.weak, .legend li.lost, .legend li.relocalized, .legend li.provisional,
.legend li.waiting {
  background: none;
}
.funnel { display: grid; gap: 0.55rem; margin-top: 1.25rem; }
.funnel .row {
  display: grid; grid-template-columns: 17.5rem 1fr 9.5rem; gap: 1rem; align-items: center;
}
.funnel .ask { line-height: 1.3; }
.funnel small { display: block; color: var(--soft); font-size: 0.82rem; }
.funnel .track-bar { display: flex; height: 14px; border-radius: 4px; }
.funnel .passed { background: var(--bar); border-radius: 4px 0 0 4px; }
.funnel .rejected { background: var(--no); border-radius: 0 4px 4px 0; opacity: 0.85; }
.funnel .accepted { background: var(--yes); border-radius: 4px; }
.funnel .ambiguous { background: var(--maybe); border-radius: 4px; }
.funnel .count { color: var(--soft); font-size: 0.9rem; text-align: right; }
.funnel .count b { color: var(--ink); font-weight: 600; }
.pairs {
  display: grid; grid-template-columns: repeat(auto-fill, minmax(min(18rem, 100%), 1fr));
  gap: 1.25rem; margin-top: 1.25rem;
}
.pair {
  background: var(--card); border: 1px solid var(--line); border-radius: 10px; overflow: hidden;
}
.pair .views { display: grid; grid-template-columns: 1fr 1fr; gap: 2px; }
.pair .view { position: relative; background: var(--bar); }
.pair .view.missing { aspect-ratio: 4 / 3; }
.pair img { display: block; width: 100%; height: auto; }
.pair .view span {
  position: absolute; left: 0.4rem; bottom: 0.4rem; padding: 0 0.4rem; border-radius: 4px;
  background: rgb(0 0 0 / 0.6); color: #fff; font-size: 0.78rem; line-height: 1.5;
}
.pair figcaption { padding: 0.7rem 0.9rem 0.85rem; font-size: 0.9rem; line-height: 1.45; }
.pair .what { display: flex; flex-wrap: wrap; justify-content: space-between; gap: 0 0.75rem; }
.pair .verdict { font-weight: 600; }
.pair .verdict.yes { color: var(--yes); }
.pair .verdict.no { color: var(--no); }
.pair .verdict.maybe { color: var(--maybe); }
.pair .scores { color: var(--soft); }
.pair p { margin: 0.25rem 0 0; overflow-wrap: anywhere; }
details { margin-top: 3.5rem; border-top: 1px solid var(--line); padding-top: 1.25rem; }
summary { cursor: pointer; font-weight: 600; }
pre {
  margin: 1rem 0 0; padding: 1rem 1.1rem; overflow-x: auto; background: var(--card);
  border: 1px solid var(--line); border-radius: 10px;
  font: 0.85rem/1.5 ui-monospace, SFMono-Regular, Menlo, Consolas, monospace;
}
@media (max-width: 44rem) {
  main { padding: 2rem 1.1rem 3.5rem; }
  h1 { font-size: 1.6rem; }
  section { margin-top: 2.6rem; }
  .figures { grid-template-columns: 1fr 1fr; }
  .figures dd { font-size: 1.05rem; }
  .funnel .row { grid-template-columns: 1fr auto; gap: 0.2rem 0.75rem; }
  .funnel .track-bar { grid-column: 1 / -1; grid-row: 2; }
  svg text { font-size: 22px; }
  svg .path { stroke-width: 4.5; }
}
@media print { .pair, section { break-inside: avoid; } }
)css";

}  // namespace

std::string_view style_sheet() { return kStyleSheet; }

}  // namespace samewhere::report

#include "calib/report/report_style.h"

namespace pixelflex::calib {

const char* const kReportHead = R"html(<!doctype html>
<html lang="en"><head><meta charset="utf-8"/><meta name="viewport" content="width=device-width, initial-scale=1"/>
<title>%TITLE%</title>
<style>
:root {
  color-scheme: light dark;
  --ink: #1c2430; --soft: #5c6675; --paper: #ffffff; --page: #f4f5f7; --line: #d9dde3; --faint: #eceff3;
  --good: #1f7a4d; --notice: #a86200; --bad: #b3261e; --arrow: #c2331f; --foot: #8b95a3;
}
@media (prefers-color-scheme: dark) { :root {
  --ink: #e6e9ee; --soft: #a0a9b6; --paper: #191d24; --page: #101318; --line: #343b46; --faint: #232933;
  --good: #5cc793; --notice: #e6a84c; --bad: #ff8a80; --arrow: #ff8a73; --foot: #77818f;
} }
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--ink);
  font: 16px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", "DejaVu Sans", sans-serif; }
main { max-width: 72rem; margin: 0 auto; padding: clamp(1rem, 3vw, 2.5rem) clamp(.75rem, 3vw, 2rem) 3rem; }
h1 { font-size: clamp(1.5rem, 4vw, 2.1rem); line-height: 1.2; letter-spacing: -.015em; margin: 0 0 .2rem; }
h2 { font-size: 1.25rem; letter-spacing: -.01em; margin: 2.6rem 0 .7rem; break-after: avoid; }
h3 { font-size: 1.1rem; margin: 0; }
p { margin: .4rem 0; max-width: 46rem; overflow-wrap: break-word; }
.sub, figcaption { color: var(--soft); font-size: .875rem; }
.sheet { background: var(--paper); border: 1px solid var(--line); border-radius: 10px; padding: clamp(.7rem, 2vw, 1.2rem); }
.verdict { margin: 1.2rem 0 0; padding: .9rem 1.1rem; border-left: 6px solid; border-radius: 10px;
  background: var(--paper); font-size: 1.1rem; font-weight: 600; max-width: none; }
.verdict.good { border-color: var(--good); } .verdict.notice { border-color: var(--notice); }
.verdict.bad { border-color: var(--bad); }
.facts { display: grid; grid-template-columns: repeat(auto-fit, minmax(9.5rem, 1fr)); gap: .75rem; margin: .75rem 0 0; }
.facts div { background: var(--paper); border: 1px solid var(--line); border-radius: 10px; padding: .6rem .9rem; }
.facts dt { color: var(--soft); font-size: .8rem; } .facts dd { margin: 0; font-size: 1.3rem; font-weight: 600; }
.facts dd small { font-size: .8rem; font-weight: 400; color: var(--soft); display: block; }
dt, dd, td, th { font-variant-numeric: tabular-nums; }
.findings { list-style: none; margin: 0; padding: 0; display: grid; gap: .6rem; }
.findings li { background: var(--paper); border: 1px solid var(--line); border-left: 5px solid; border-radius: 8px;
  padding: .6rem .9rem; break-inside: avoid; overflow-wrap: anywhere; }
.findings li.notice { border-left-color: var(--notice); } .findings li.bad { border-left-color: var(--bad); }
.findings p { margin: .15rem 0; max-width: none; }
.why { display: grid; grid-template-columns: 3.6rem 1fr; gap: 0 .4rem; margin: .2rem 0 0; font-size: .875rem; color: var(--soft); }
.why dt { font-weight: 600; } .why dd { margin: 0; }
code { font: .92em ui-monospace, "DejaVu Sans Mono", monospace; color: var(--ink); background: var(--faint);
  padding: .05em .35em; border-radius: 4px; white-space: nowrap; }
.remark { border-left: 3px solid var(--notice); padding-left: .6rem; margin: 0 0 .4rem; font-size: .875rem; max-width: none; }
.tag { font-size: .72rem; font-weight: 700; text-transform: uppercase; letter-spacing: .05em; margin-right: .5em; }
.tag.good { color: var(--good); } .tag.notice { color: var(--notice); } .tag.bad { color: var(--bad); }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: .9rem; }
th, td { padding: .38rem .65rem; text-align: right; white-space: nowrap; }
th { font-weight: 600; color: var(--soft); border-bottom: 1.5px solid var(--line); vertical-align: bottom; font-size: .8rem; }
tbody th { color: inherit; border: 0; font-size: inherit; vertical-align: middle; }
tbody tr + tr > * { border-top: 1px solid var(--faint); }
th:first-child, td.words, th.words { text-align: left; } td.words { white-space: normal; min-width: 15rem; }
tr { break-inside: avoid; } thead { display: table-header-group; }
.chip { display: inline-block; width: .75em; height: .75em; border-radius: 3px; margin-right: .45em; }
figure { margin: 0; break-inside: avoid; } figcaption { margin-top: .35rem; }
svg, img.frame { display: block; width: 100%; height: auto; }
svg text { fill: currentColor; font-family: inherit; }
svg.wall { max-height: 38rem; } svg.legend { max-width: 26rem; margin-top: .6rem; }
.name { font-weight: 600; paint-order: stroke; stroke: var(--paper); stroke-linejoin: round; }
.display { fill: none; stroke: var(--ink); } .fiducial, .rule { fill: none; stroke: var(--ink); }
.hole { stroke: var(--bad); } .outline { fill: none; stroke: #000; stroke-opacity: .35; }
.iso { fill: none; stroke: #16202c; } .legend .iso { stroke: var(--ink); }
.paper { fill: var(--faint); } .arrow { fill: none; stroke: var(--arrow); stroke-linecap: round; stroke-linejoin: round; }
.foot { fill: none; stroke: var(--foot); stroke-linecap: round; }
.photo { background: #000; border-radius: 4px; } .edge { fill: none; stroke: #ffffff; stroke-opacity: .55; }
.found { fill: none; stroke: #35e0a1; stroke-linecap: round; }
.missing { fill: none; stroke: #ff4d4d; stroke-linecap: round; }
img.frame { border-radius: 3px; outline: 1px solid var(--line); }
article { margin-top: 1rem; break-inside: avoid; }
article header { display: flex; flex-wrap: wrap; gap: .2rem .9rem; align-items: baseline; margin-bottom: .7rem; }
.figures { display: grid; grid-template-columns: repeat(12, 1fr); gap: 1rem; align-items: start; }
.figures > .wide { grid-column: span 7; } .figures > .high { grid-column: span 5; }
.figures > .third { grid-column: span 4; }
.facts + .sheet, section > .sheet + .sheet { margin-top: .75rem; }
.pair { margin: 0 0 1.2rem; } .both { display: grid; grid-template-columns: 1fr 1fr; gap: .2rem .8rem; }
.charts { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 21rem), 1fr)); gap: 1.2rem; margin-top: .8rem; }
.line { fill: none; stroke-linejoin: round; } .sum { stroke: var(--ink); } .ideal { stroke: var(--soft); }
.red { stroke: #d0342c; } .green { stroke: #2e9e4f; } .blue { stroke: #3a6fe0; }
.grid { fill: none; stroke: var(--line); } .shared { fill: var(--foot); fill-opacity: .18; } .chart text { fill: var(--soft); }
.numbers { display: grid; grid-template-columns: 1fr auto; gap: .15rem 1rem; margin: 0; font-size: .875rem; }
.numbers dt { color: var(--soft); } .numbers dd { margin: 0; text-align: right; }
.terms { columns: 20rem; column-gap: 2rem; font-size: .875rem; margin: 0; } .terms dt { font-weight: 600; }
.terms dd { margin: 0 0 .6rem; color: var(--soft); } .terms dt { break-after: avoid; } .terms dd { break-inside: avoid; }
footer { margin-top: 2.5rem; color: var(--soft); font-size: .8rem; }
@media (max-width: 52rem) {
  .figures > .wide, .figures > .high { grid-column: span 12; } .figures > .third { grid-column: span 6; }
}
@media (max-width: 30rem) { .both { grid-template-columns: 1fr; } code { white-space: normal; } .figures > .third { grid-column: span 12; } th, td { padding: .35rem .4rem; } }
@page { size: A4; margin: 14mm 13mm; }
@media print {
  :root { color-scheme: light;
    --ink: #111820; --soft: #4b5563; --paper: #ffffff; --page: #ffffff; --line: #c9ced6; --faint: #f0f2f5;
    --good: #1f7a4d; --notice: #a86200; --bad: #b3261e; --arrow: #c2331f; --foot: #8b95a3; }
  * { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
  html { font-size: 9.5pt; } body { font-size: 1rem; } main { max-width: none; padding: 0; }
  .scroll { overflow: visible; } table { font-size: 7.6pt; } th { font-size: 7pt; } th, td { padding: .2rem .25rem; }
  td.words { min-width: 6rem; }
  svg.wall { max-height: 105mm; }
  h2 { margin-top: 1.4rem; } .part { break-inside: avoid; } .projectors > article { break-inside: avoid; }
  .figures > .wide { grid-column: span 7; } .figures > .high { grid-column: span 5; }
  .figures > .third { grid-column: span 4; }
}
</style></head><body>
)html";

const char* const kReportPatterns =
    R"html(<svg width="0" height="0" aria-hidden="true" style="position:absolute"><defs>
<pattern id="hatch" width="8" height="8" patternTransform="rotate(45)" patternUnits="objectBoundingBox" viewBox="0 0 8 8">
<path d="M0 0V8" stroke="#b3261e" stroke-width="1.5"/></pattern></defs></svg>
)html";

}  // namespace pixelflex::calib

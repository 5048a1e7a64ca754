#include "viewer/remote/status_page.h"

#include <string_view>

namespace pixelflex::viewer {
namespace {

constexpr std::string_view kPage = R"page(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>PixelFlex</title>
<link rel="stylesheet" href="status.css">
<script src="status.js" defer></script>
</head>
<body>
<header><h1 id="name">PixelFlex</h1><p id="power" role="status">…</p></header>
<form id="login" hidden>
  <label>Token <input id="token" type="password" autocomplete="current-password"></label> <button>Use it</button>
</form>
<main id="wall" hidden>
  <div class="row">
    <button data-path="power" data-on="true">Power on</button>
    <button data-path="power" data-on="false" data-ask="Switch every projector off?">Power off</button>
  </div>
  <div class="row">
    <button data-path="mute" data-on="true" id="mute">Mute the picture</button>
    <button data-path="mute" data-on="false" id="unmute">Show the picture</button>
  </div>
  <div class="row"><button data-path="halt" class="stop">STOP ALL</button></div>
  <h2>Presets</h2>
  <div id="presets" class="row"></div>
  <h2>Orders</h2>
  <ul id="jobs"></ul>
  <h2>Devices</h2>
  <table><tbody id="devices"></tbody></table>
</main>
<p id="trouble" role="alert"></p>
</body>
</html>
)page";

constexpr std::string_view kStyle =
    R"page(:root { color-scheme: dark; --line: #3a4048; --well: #58c98b; --bad: #ff7b72; }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 44rem; padding: 1rem; background: #14171b; color: #e6e9ec;
  font: 1rem/1.4 system-ui, sans-serif; }
header { display: flex; align-items: baseline; justify-content: space-between; gap: 1rem; }
h1 { font-size: 1.4rem; margin: 0; overflow-wrap: anywhere; }
h2 { font-size: 1rem; margin: 1.5rem 0 .5rem; color: #9aa4af; font-weight: 600; }
#power { margin: 0; font-weight: 600; }
#power.on { color: var(--well); }
.row { display: flex; flex-wrap: wrap; gap: .6rem; margin-top: .6rem; }
button { flex: 1 1 8rem; min-height: 3rem; padding: .5rem 1rem; font: inherit; color: inherit; background: #232830;
  border: 1px solid var(--line); border-radius: .5rem; }
button:active { background: #303742; }
button:focus-visible { outline: 2px solid #79b8ff; }
button.chosen { border-color: var(--well); }
button.stop { background: #8e1519; border-color: #c9302c; font-weight: 700; letter-spacing: .08em; }
#login { margin: 1rem 0; display: flex; gap: .6rem; flex-wrap: wrap; align-items: end; }
#login[hidden], main[hidden] { display: none; }
input { font: inherit; min-height: 3rem; padding: .5rem; background: #0d0f12; color: inherit;
  border: 1px solid var(--line); border-radius: .5rem; }
ul { margin: 0; padding: 0; list-style: none; }
li, td { padding: .35rem 0; border-bottom: 1px solid var(--line); overflow-wrap: anywhere; }
table { width: 100%; border-collapse: collapse; }
td { vertical-align: top; padding-right: .8rem; }
td:first-child { white-space: nowrap; }
.bad { color: var(--bad); }
.quiet { color: #9aa4af; }
#trouble { color: var(--bad); min-height: 1.4em; }
)page";

constexpr std::string_view kScript = R"page('use strict';
const $ = id => document.getElementById(id);
const make = (tag, text, kind) => Object.assign(document.createElement(tag), {textContent: text, className: kind || ''});

async function ask(path, options) {
  const headers = {'Content-Type': 'application/json'};
  const token = sessionStorage.getItem('token');
  if (token) headers.Authorization = 'Bearer ' + token;
  const reply = await fetch(path, {headers, cache: 'no-store', ...options});
  $('login').hidden = reply.status !== 401;
  const json = await reply.json();
  if (!reply.ok) throw new Error(json.error);
  return json;
}

async function order(path, body) {
  try {
    await ask(path, {method: 'POST', body: JSON.stringify(body)});
    $('trouble').textContent = '';
  } catch (error) {
    $('trouble').textContent = error.message;
  }
  show();
}

function deviceRow(device) {
  const lost = device.contact === 'lost';
  const told = ['power', 'input', 'mute', 'errors', 'hours', 'pan', 'tilt'].flatMap(name => {
    const setting = device.settings[name];
    if (!setting || setting.value === null) return [];
    return [name + ' ' + setting.value + (setting.unit ? ' ' + setting.unit : '')];
  });
  const row = make('tr', '');
  row.append(make('td', device.name), make('td', device.trouble || device.doing || told.join(', ') || device.contact,
    device.trouble ? 'bad' : lost ? 'quiet' : ''));
  return row;
}

function jobLine(job) {
  const part = job.part === null ? '' : ' ' + Math.round(100 * job.part) + ' %';
  const what = job.command.replace(/^pixelflex (\S+) ('[^']*'|\S+)/, '$1');
  const came = {done: 'done', failed: job.error}[job.state] || (job.doing || 'running') + part;
  return make('li', what + ': ' + came, job.state === 'failed' ? 'bad' : '');
}

function presetButton(preset, chosen) {
  const button = make('button', preset.name, preset.name === chosen ? 'chosen' : '');
  button.title = preset.trouble || 'saved ' + preset.saved;
  button.onclick = () => order('presets/' + encodeURIComponent(preset.name) + '/restore', {});
  return button;
}

let shown = '';
async function show() {
  try {
    const wall = await ask('state');
    $('wall').hidden = false;
    if (shown === '' + wall.revision) return;
    shown = '' + wall.revision;
    document.title = $('name').textContent = wall.name;
    $('power').textContent = (wall.partly ? 'partly ' : '') + wall.power + (wall.muted ? ', muted' : '');
    $('power').className = wall.power;
    $('mute').className = wall.muted ? 'chosen' : '';
    $('unmute').className = wall.muted === false ? 'chosen' : '';
    $('presets').replaceChildren(...wall.presets.map(preset => presetButton(preset, wall.preset)));
    if (!wall.presets.length) $('presets').append(make('p', 'none saved', 'quiet'));
    $('jobs').replaceChildren(...wall.jobs.slice(-4).reverse().map(jobLine));
    $('devices').replaceChildren(...wall.devices.map(deviceRow));
  } catch (error) {
    shown = '';
    $('wall').hidden = true;
    $('power').textContent = error instanceof TypeError ? 'does not answer' : error.message;
  }
}

for (const button of document.querySelectorAll('button[data-path]')) {
  button.onclick = () => {
    if (button.dataset.ask && !confirm(button.dataset.ask)) return;
    order(button.dataset.path, button.dataset.on ? {on: button.dataset.on === 'true'} : {});
  };
}
$('login').onsubmit = event => {
  event.preventDefault();
  sessionStorage.setItem('token', $('token').value);
  show();
};
setInterval(() => document.hidden || show(), 1000);
show();
)page";

HttpReply file(std::string_view text, const char* type) {
  return {.status = 200, .body = std::string(text), .type = std::string(type) + "; charset=utf-8"};
}

}  // namespace

std::optional<HttpReply> statusPage(const std::string& name) {
  if (name.empty()) return file(kPage, "text/html");
  if (name == "status.css") return file(kStyle, "text/css");
  if (name == "status.js") return file(kScript, "text/javascript");
  return std::nullopt;
}

}  // namespace pixelflex::viewer

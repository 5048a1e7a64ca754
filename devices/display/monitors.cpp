#include "devices/display/monitors.h"

#include <fmt/format.h>
#include <xcb/randr.h>
#include <xcb/xcb.h>

#include <cstdlib>
#include <memory>

#include "devices/display/display_error.h"

namespace pixelflex::devices {
namespace {

struct Free {
  void operator()(void* memory) const { std::free(memory); }
};
template <class Reply>
std::unique_ptr<Reply, Free> owned(Reply* reply) {
  return std::unique_ptr<Reply, Free>(reply);
}

struct Disconnect {
  void operator()(xcb_connection_t* x) const { xcb_disconnect(x); }
};

xcb_window_t rootOf(xcb_connection_t* x, int screen) {
  auto roots = xcb_setup_roots_iterator(xcb_get_setup(x));
  for (; screen > 0 && roots.rem > 1; --screen) xcb_screen_next(&roots);
  return roots.data->root;
}

std::string nameOf(xcb_connection_t* x, xcb_atom_t atom) {
  const auto reply = owned(xcb_get_atom_name_reply(x, xcb_get_atom_name(x, atom), nullptr));
  if (reply == nullptr) return {};
  const auto length = static_cast<std::size_t>(xcb_get_atom_name_name_length(reply.get()));
  return {xcb_get_atom_name_name(reply.get()), length};
}

}  // namespace

std::vector<Monitor> listMonitors(const EventLoop& /*loop*/) {
  int screen = 0;
  const std::unique_ptr<xcb_connection_t, Disconnect> x(xcb_connect(nullptr, &screen));
  if (xcb_connection_has_error(x.get()) != 0) throw DisplayError("cannot list monitors: the X server does not answer");
  std::free(xcb_randr_query_version_reply(x.get(), xcb_randr_query_version(x.get(), 1, 5), nullptr));
  const xcb_window_t root = rootOf(x.get(), screen);
  const auto reply = owned(xcb_randr_get_monitors_reply(x.get(), xcb_randr_get_monitors(x.get(), root, 1), nullptr));
  std::vector<Monitor> monitors;
  if (reply == nullptr) return monitors;
  for (auto each = xcb_randr_get_monitors_monitors_iterator(reply.get()); each.rem > 0;
       xcb_randr_monitor_info_next(&each)) {
    const auto& info = *each.data;
    const Monitor monitor{nameOf(x.get(), info.name), {info.x, info.y}, {info.width, info.height}};
    monitors.insert(info.primary != 0 ? monitors.begin() : monitors.end(), monitor);
  }
  return monitors;
}

Monitor findMonitor(const EventLoop& loop, const std::string& name) {
  std::string names;
  for (const auto& monitor : listMonitors(loop)) {
    if (monitor.name == name) return monitor;
    names += (names.empty() ? "" : ", ") + monitor.name;
  }
  throw DisplayError(fmt::format("there is no monitor '{}'; there are: {}", name, names.empty() ? "none" : names));
}

}  // namespace pixelflex::devices

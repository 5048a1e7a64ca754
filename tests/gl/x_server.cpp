#include "tests/gl/x_server.h"

#include <X11/Xutil.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <span>
#include <stdexcept>

namespace pixelflex::testing {
namespace {

/// The display's number, which the server writes once it listens.
std::string readNumber(int pipe) {
  std::string number;
  char letter = 0;
  pollfd waiting{pipe, POLLIN, 0};
  while (poll(&waiting, 1, 20000) > 0 && read(pipe, &letter, 1) == 1 && letter != '\n') number += letter;
  return number;
}

}  // namespace

XServer::XServer(int width, int height, int depth) : pixelMask_((1U << depth) - 1) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw std::runtime_error("no pipe");
  const auto screen = std::to_string(width) + "x" + std::to_string(height) + "x" + std::to_string(depth);
  const auto writeEnd = std::to_string(ends[1]);
  process_ = fork();
  if (process_ == 0) {
    close(ends[0]);
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDERR_FILENO);
    execlp("Xvfb", "Xvfb", "-displayfd", writeEnd.c_str(), "-screen", "0", screen.c_str(), "-nolisten", "tcp",
           "-noreset", static_cast<char*>(nullptr));
    _exit(127);
  }
  close(ends[1]);
  const auto number = readNumber(ends[0]);
  close(ends[0]);
  if (number.empty()) throw std::runtime_error("Xvfb does not start");
  display_ = ":" + number;
  setenv("DISPLAY", display_.c_str(), 1);
  connection_ = XOpenDisplay(display_.c_str());
  if (connection_ == nullptr) throw std::runtime_error("Xvfb does not answer");
}

XServer::~XServer() {
  if (connection_ != nullptr) XCloseDisplay(connection_);
  kill(process_, SIGTERM);
  waitpid(process_, nullptr, 0);
}

std::uint32_t XServer::colourAt(int x, int y) const {
  XImage* const image = XGetImage(connection_, DefaultRootWindow(connection_), x, y, 1, 1, AllPlanes, ZPixmap);
  if (image == nullptr) return 0xFFFFFFFF;
  const auto pixel = static_cast<std::uint32_t>(XGetPixel(image, 0, 0));
  XDestroyImage(image);
  return pixel & pixelMask_;
}

::Window XServer::findWindow(const std::string& title) const {
  ::Window root = 0;
  ::Window parent = 0;
  ::Window* children = nullptr;
  unsigned count = 0;
  XQueryTree(connection_, DefaultRootWindow(connection_), &root, &parent, &children, &count);
  ::Window found = 0;
  for (const auto child : std::span(children, count)) {
    char* name = nullptr;
    if (XFetchName(connection_, child, &name) == 0) continue;
    if (title == name) found = child;
    XFree(name);
  }
  XFree(children);
  return found;
}

bool XServer::askToClose(const std::string& title) const {
  XEvent event{};
  event.xclient.type = ClientMessage;
  event.xclient.window = findWindow(title);
  event.xclient.message_type = XInternAtom(connection_, "WM_PROTOCOLS", False);
  event.xclient.format = 32;
  event.xclient.data.l[0] = static_cast<long>(XInternAtom(connection_, "WM_DELETE_WINDOW", False));
  if (event.xclient.window == 0) return false;
  XSendEvent(connection_, event.xclient.window, False, NoEventMask, &event);
  XFlush(connection_);
  return true;
}

}  // namespace pixelflex::testing

#include "viewer/remote/http_wall.h"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <ctime>
#include <exception>
#include <optional>
#include <string_view>

#include "viewer/remote/http_guard.h"
#include "viewer/remote/http_orders.h"
#include "viewer/remote/remote_error.h"
#include "viewer/remote/status_page.h"
#include "viewer/remote/wall_json.h"

namespace pixelflex::viewer {
namespace {

using Kind = RemoteError::Kind;
using Words = std::vector<std::string>;

[[noreturn]] void unknown(const std::string& what) {
  throw RemoteError(Kind::kUnknown, "there is no " + what);
}

int statusOf(Kind kind) {
  constexpr std::array<int, 4> kStatuses = {400, 404, 409, 409};
  return kStatuses.at(static_cast<std::size_t>(kind));
}

std::string decoded(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned char byte = 0;
    const bool escapes = text[i] == '%' && i + 2 < text.size();
    const auto* digits = text.data() + i + 1;
    if (escapes && std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2) {
      result += static_cast<char>(byte);
      i += 2;
    } else {
      result += text[i];
    }
  }
  return result;
}

/// Split first, then decoded: a slash that is written %2F is part of a name, and no name has one.
Words pathOf(std::string_view target) {
  target = target.substr(0, target.find('?'));
  Words words;
  while (!target.empty()) {
    target.remove_prefix(target.front() == '/' ? 1 : 0);
    const auto end = std::min(target.find('/'), target.size());
    words.push_back(decoded(target.substr(0, end)));
    target.remove_prefix(end);
  }
  if (!words.empty() && words.back().empty()) words.pop_back();
  return words;
}

std::string queryOf(const std::string& target) {
  const auto mark = target.find('?');
  return mark == std::string::npos ? "" : target.substr(mark + 1);
}

template <class Number>
std::optional<Number> numberOf(std::string_view text) {
  Number number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

/// When a file was written, ISO 8601; empty when there is none.
std::string writtenAt(const std::filesystem::path& file) {
  struct stat about {};
  std::tm parts{};
  if (::stat(file.c_str(), &about) != 0 || ::gmtime_r(&about.st_mtim.tv_sec, &parts) == nullptr) return {};
  std::array<char, 32> text{};
  return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

/// What may be done with a path; empty: there is nothing there.
std::string methodsOf(const Words& path) {
  const std::string first = path.empty() ? "" : path[0];
  if (path.empty() || (path.size() == 1 && (first == "state" || first == "presets" || first == "log"))) return "GET";
  if (path.size() == 1) {
    constexpr std::array<std::string_view, 5> kOrders = {"power", "mute", "freeze", "halt", "calibrate"};
    return std::ranges::find(kOrders, first) != kOrders.end() ? "POST" : "";
  }
  if (path.size() == 2 && first == "devices") return "GET, POST";
  if (path.size() == 2 && first == "jobs") return "GET, DELETE";
  if (path.size() == 2 && first == "presets") return "PUT, DELETE";
  return path.size() == 3 && first == "presets" && path[2] == "restore" ? "POST" : "";
}

HttpReply failed(int status, const std::string& why) {
  return {.status = status, .body = errorJson(why)};
}

bool isAmong(const std::string& methods, const std::string& method) {
  return (", " + methods + ",").find(", " + method + ",") != std::string::npos;
}

}  // namespace

HttpReply HttpWall::answer(const HttpRequest& request) {
  try {
    const Words path = pathOf(request.target);
    if (auto page = request.method == "GET" ? statusPage(path.empty() ? "" : path.back()) : std::nullopt;
        page && path.size() < 2) {
      return pageRefusal(request, options_.token).value_or(*page);
    }
    if (auto reply = refusal(request, options_.token)) return *reply;
    const std::string methods = methodsOf(path);
    if (methods.empty()) unknown("\"" + request.target.substr(0, 80) + "\" here; see pixelflex serve --help");
    if (!isAmong(methods, request.method)) {
      HttpReply reply = failed(405, "this takes " + methods);
      reply.headers.emplace_back("Allow", methods);
      return reply;
    }
    return request.method == "GET" ? read(path, queryOf(request.target)) : order(request, path);
  } catch (const RemoteError& error) {
    return failed(statusOf(error.kind()), error.what());
  } catch (const std::exception& error) {
    return failed(500, error.what());
  }
}

HttpReply HttpWall::read(const Words& path, const std::string& query) const {
  const auto wall = remote_.snapshot();
  if (path[0] == "state") return state();
  if (path[0] == "presets") return {.body = presetsJson(*wall)};
  if (path[0] == "log") {
    const std::string after = query.starts_with("after=") ? query.substr(6) : "0";
    return {.body = logJson(*wall, numberOf<std::uint64_t>(after).value_or(0))};
  }
  if (path[0] == "devices") {
    const DeviceState* device = wall->find(path[1]);
    if (device == nullptr) unknown("device \"" + path[1].substr(0, 80) + "\"; /state lists them");
    return {.body = deviceJson(*device)};
  }
  const auto* job = wall->find(numberOf<int>(path[1]).value_or(0));
  if (job == nullptr) unknown("job \"" + path[1].substr(0, 80) + "\" (any more)");
  return {.body = jobJson(*job)};
}

HttpReply HttpWall::state() const {
  const std::string calibrated = writtenAt(remote_.console().folder() / "calibration.yaml");
  return {.body = stateJson(*remote_.snapshot(), remote_.summary(), options_.name, calibrated)};
}

HttpReply HttpWall::order(const HttpRequest& request, const Words& path) {
  if (path[0] == "jobs") return cancel(path[1]);
  if (path[0] == "devices") return started(remote_.device(path[1], parseSteps(request.body)));
  if (path.size() == 3) return restore(path[1], request.body);
  if (path[0] == "presets") return changePreset(request.method, path[1], request.body);
  return orderAll(path[0], request.body);
}

HttpReply HttpWall::orderAll(const std::string& what, const std::string& body) {
  if (what == "calibrate") return started(remote_.calibrate(parseCalibrate(body)));
  if (what != "halt") return started(remote_.setAll(what, parseOn(body)));
  parseNothing(body);
  return started(remote_.halt());
}

HttpReply HttpWall::changePreset(const std::string& method, const std::string& name, const std::string& body) {
  parseNothing(body);
  return started(method == "PUT" ? remote_.savePreset(name) : remote_.deletePreset(name));
}

HttpReply HttpWall::restore(const std::string& name, const std::string& body) {
  const auto [verify, dryRun] = parseRestore(body);
  return started(dryRun ? remote_.planPreset(name) : remote_.restorePreset(name, verify));
}

HttpReply HttpWall::cancel(const std::string& job) {
  const int number = numberOf<int>(job).value_or(0);
  remote_.cancel(number);
  return started(number);
}

/// Quick ones have ended by now.
HttpReply HttpWall::started(int job) const {
  const auto wall = remote_.snapshot();
  const ConsoleJob* found = wall->find(job);
  if (found == nullptr) return failed(500, "job " + std::to_string(job) + " is gone already");
  HttpReply reply{.status = 202, .body = jobJson(*found)};
  reply.headers.emplace_back("Location", "/jobs/" + std::to_string(job));
  return reply;
}

}  // namespace pixelflex::viewer

#include "viewer/remote/http_guard.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "viewer/remote/wall_json.h"

namespace pixelflex::viewer {
namespace {

HttpReply refused(int status, const std::string& why) {
  return {.status = status, .body = errorJson(why)};
}

std::string lowered(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

/// "localhost:8080" without the port.
std::string_view nameIn(std::string_view host) {
  const auto colon = host.rfind(':');
  const auto bracket = host.rfind(']');
  const bool hasPort = colon != std::string_view::npos && (bracket == std::string_view::npos || colon > bracket);
  return hasPort ? host.substr(0, colon) : host;
}

bool isThisMachine(std::string_view host) {
  constexpr std::array<std::string_view, 3> kNames = {"localhost", "127.0.0.1", "[::1]"};
  return std::ranges::find(kNames, nameIn(lowered(host))) != kNames.end();
}

bool changesSomething(const HttpRequest& request) {
  return request.method != "GET" && request.method != "HEAD";
}

bool isJson(const HttpRequest& request) {
  std::string type = lowered(request.contentType.substr(0, request.contentType.find(';')));
  type.erase(type.find_last_not_of(" \t") + 1);
  return type == "application/json";
}

bool isOfAnotherSite(const HttpRequest& request) {
  if (!request.origin.empty() && lowered(request.origin) != "http://" + lowered(request.host) &&
      lowered(request.origin) != "https://" + lowered(request.host)) {
    return true;
  }
  const std::string& site = request.fetchSite;
  return !site.empty() && site != "same-origin" && site != "none";
}

bool carries(const HttpRequest& request, const std::string& token) {
  constexpr std::string_view kScheme = "bearer ";
  const std::string& given = request.authorization;
  if (lowered(given.substr(0, kScheme.size())) != kScheme) return false;
  return isSameSecret(given.substr(kScheme.size()), token);
}

}  // namespace

bool isSameSecret(std::string_view a, std::string_view b) {
  unsigned difference = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const char other = b.empty() ? '\0' : b[i % b.size()];
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(other);
  }
  return difference == 0;
}

std::optional<HttpReply> pageRefusal(const HttpRequest& request, const std::string& token) {
  if (token.empty() && !isThisMachine(request.host)) {
    return refused(421, "without a token only localhost, 127.0.0.1 and [::1] are answered, not Host \"" +
                            request.host.substr(0, 80) + "\"");
  }
  return std::nullopt;
}

std::optional<HttpReply> refusal(const HttpRequest& request, const std::string& token) {
  if (auto reply = pageRefusal(request, token)) return reply;
  if (isOfAnotherSite(request)) return refused(403, "pages of other sites may not ask this wall for anything");
  if (!token.empty() && !carries(request, token)) {
    HttpReply reply = refused(401, "a token is needed: Authorization: Bearer TOKEN");
    reply.headers.emplace_back("WWW-Authenticate", "Bearer");
    return reply;
  }
  if (changesSomething(request) && !isJson(request)) return refused(415, "say Content-Type: application/json");
  return std::nullopt;
}

}  // namespace pixelflex::viewer

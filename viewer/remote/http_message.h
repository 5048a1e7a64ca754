#pragma once

#include <string>
#include <utility>
#include <vector>

namespace pixelflex::viewer {

/// What of a request matters here.
struct HttpRequest {
  std::string method = "GET";
  std::string target = "/";  // as it came: path and query, percent-encoded
  std::string body;
  // Headers, empty where there are none.
  std::string host;
  std::string origin;
  std::string fetchSite;  // Sec-Fetch-Site
  std::string contentType;
  std::string authorization;
};

struct HttpReply {
  int status = 200;
  std::string body;
  std::string type = "application/json";
  std::vector<std::pair<std::string, std::string>> headers = {};
};

}  // namespace pixelflex::viewer

#pragma once

#include <cstddef>
#include <regex>
#include <string>
#include <vector>

namespace pixelflex::calib {

inline std::size_t count(const std::string& text, const std::string& part) {
  std::size_t number = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++number;
  return number;
}

/// What is wrong with the nesting of a page whose empty elements all end in "/>"; empty when nothing is.
inline std::string nestingProblem(const std::string& html) {
  std::vector<std::string> open;
  for (auto at = html.find('<'); at != std::string::npos; at = html.find('<', at + 1)) {
    const auto end = html.find('>', at);
    if (end == std::string::npos) return "a tag does not end";
    const std::string tag = html.substr(at + 1, end - at - 1);
    if (tag.starts_with("!doctype") || tag.ends_with('/')) continue;
    if (count(tag, "\"") % 2 != 0) return "an attribute does not end in <" + tag + ">";
    const std::string name = tag.substr(tag.starts_with('/') ? 1 : 0, tag.find(' ') - (tag.starts_with('/') ? 1 : 0));
    if (!tag.starts_with('/')) {
      open.push_back(tag.substr(0, tag.find(' ')));
    } else if (open.empty() || open.back() != name) {
      return "</" + name + "> closes " + (open.empty() ? "nothing" : open.back());
    } else {
      open.pop_back();
    }
  }
  return open.empty() ? "" : open.back() + " is not closed";
}

/// Everything that a browser would fetch.
inline std::vector<std::string> fetched(const std::string& html) {
  static const std::regex kSource(R"rx((?:\ssrc|\shref|url\(|@import|<script|<link)\s*=?\s*"?([^">) ]{0,12}))rx");
  std::vector<std::string> sources;
  for (std::sregex_iterator it(html.begin(), html.end(), kSource), end; it != end; ++it) {
    const std::string target = (*it)[1];
    if (!target.starts_with("data:image/") && !target.starts_with("#")) sources.push_back(it->str());
  }
  return sources;
}

}  // namespace pixelflex::calib

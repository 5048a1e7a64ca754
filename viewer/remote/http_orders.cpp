#include "viewer/remote/http_orders.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string_view>

#include "viewer/remote/remote_error.h"

namespace pixelflex::viewer {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kDeepest = 4;
constexpr std::size_t kMostSteps = 100;

[[noreturn]] void refuse(const std::string& why) {
  throw RemoteError(RemoteError::Kind::kWrong, why);
}

Json parsed(const std::string& body) {
  if (body.empty()) return Json::object();
  bool deep = false;
  const auto watch = [&](int depth, Json::parse_event_t, Json&) {
    deep = deep || depth > kDeepest;
    return !deep;
  };
  const Json json = Json::parse(body, watch, false);
  if (deep || json.is_discarded()) refuse("the body is no JSON that means anything here");
  return json;
}

/// Nothing but these keys.
Json object(const std::string& body, std::initializer_list<std::string_view> keys) {
  const Json json = parsed(body);
  std::string list;
  for (const auto key : keys) list += (list.empty() ? "" : ", ") + std::string(key);
  const std::string allowed = list.empty() ? "write {}" : "it may hold " + list;
  if (!json.is_object()) refuse("the body is no JSON object; " + allowed);
  for (const auto& [key, value] : json.items()) {
    if (std::ranges::find(keys, key) == keys.end())
      refuse("\"" + key.substr(0, 80) + "\" means nothing here; " + allowed);
  }
  return json;
}

bool flag(const Json& json, const char* key) {
  if (!json.contains(key)) return false;
  if (!json[key].is_boolean()) refuse(std::string(key) + " is true or false");
  return json[key].get<bool>();
}

std::string settingText(const std::string& name, const Json& value) {
  if (value.is_boolean()) return value.get<bool>() ? "on" : "off";
  if (value.is_number()) return value.dump();
  if (value.is_string()) return value.get<std::string>();
  refuse(name.substr(0, 80) + ": a setting's value is a number, a word, true or false");
}

/// Letters, digits, '_', '-' and '.', not first: nothing that calibrate could take for an option or a path.
std::string plainWord(const Json& json, const std::string& what) {
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
           c == '.';
  };
  const std::string word = json.is_string() ? json.get<std::string>() : "";
  if (word.empty() || word.front() == '-' || word.front() == '.' || !std::ranges::all_of(word, fits)) {
    refuse(what + ": a name is made of letters, digits, '_', '-' and '.'");
  }
  return word;
}

std::vector<std::string> wordsOf(const Json& json, const char* key) {
  std::vector<std::string> words;
  if (!json.contains(key)) return words;
  if (!json[key].is_array() || json[key].size() > kMostSteps) refuse(std::string(key) + " is a list of names");
  for (const auto& each : json[key]) words.push_back(plainWord(each, key));
  return words;
}

}  // namespace

bool parseOn(const std::string& body) {
  const Json json = object(body, {"on"});
  if (!json.contains("on")) refuse(R"(write {"on": true} or {"on": false})");
  return flag(json, "on");
}

std::vector<std::string> parseSteps(const std::string& body) {
  const Json json = parsed(body);
  std::vector<std::string> steps;
  if (!json.is_structured() || json.empty() || json.size() > kMostSteps) {
    refuse(R"(write {"SETTING": VALUE, …} or ["SETTING+=2", "home", …])");
  }
  for (const auto& [name, value] : json.items()) {
    if (json.is_array() && !value.is_string()) refuse(R"(steps are words such as "pan+=2" or "home")");
    steps.push_back(json.is_array() ? value.get<std::string>() : name + "=" + settingText(name, value));
  }
  return steps;
}

RestoreOrder parseRestore(const std::string& body) {
  const Json json = object(body, {"verify", "dry_run"});
  return {.verify = flag(json, "verify"), .dryRun = flag(json, "dry_run")};
}

std::vector<std::string> parseCalibrate(const std::string& body) {
  constexpr std::array<std::string_view, 6> kSteps = {"camera", "surface", "projectors", "mesh", "blend", "gamma"};
  const Json json = object(body, {"steps", "all", "check", "only", "skip", "method"});
  std::vector<std::string> arguments = wordsOf(json, "steps");
  for (const auto& step : arguments) {
    if (std::ranges::find(kSteps, step) == kSteps.end()) {
      refuse("\"" + step + "\" is no step: there are camera, surface, projectors, mesh, blend and gamma");
    }
  }
  if (flag(json, "all")) arguments.emplace_back("--all");
  if (flag(json, "check")) arguments.emplace_back("--check");
  if (json.contains("method")) arguments.insert(arguments.end(), {"--method", plainWord(json["method"], "method")});
  for (const auto* key : {"only", "skip"}) {
    std::string names;
    for (const auto& name : wordsOf(json, key)) names += (names.empty() ? "" : ",") + name;
    if (!names.empty()) arguments.insert(arguments.end(), {std::string("--") + key, names});
  }
  return arguments;
}

void parseNothing(const std::string& body) {
  (void)object(body, {});
}

}  // namespace pixelflex::viewer

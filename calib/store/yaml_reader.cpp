#include "calib/store/yaml_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "calib/store/spelling.h"
#include "calib/store/yaml_document.h"
#include "calib/store/yaml_text.h"

namespace pixelflex::calib {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string rangeText(double minimum, double maximum) {
  const bool low = std::isfinite(minimum);
  const bool high = std::isfinite(maximum);
  if (low && high) return " from " + yamlNumber(minimum) + " to " + yamlNumber(maximum);
  if (low) return " of at least " + yamlNumber(minimum);
  return high ? " of at most " + yamlNumber(maximum) : "";
}

template <class Value>
std::optional<Value> parseWhole(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Value value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

struct YamlReader::State {
  std::string file;
  YamlDocument document;
  std::map<std::size_t, std::set<std::string>> asked;  // map node to the keys that a reader knows
};

struct YamlReader::Node::Data {
  std::shared_ptr<State> state;
  std::size_t index = 0;
  std::string name;  // the nearest key above, for messages
  [[nodiscard]] const YamlNode& node() const { return state->document.nodes[index]; }
};

YamlReader::Node::Node(std::shared_ptr<const Data> data) : data_(std::move(data)) {}

bool YamlReader::Node::defined() const {
  return data_ != nullptr;
}
bool YamlReader::Node::isMap() const {
  return defined() && data_->node().kind == YamlNode::Kind::kMap;
}
bool YamlReader::Node::isSequence() const {
  return defined() && data_->node().kind == YamlNode::Kind::kSequence;
}
bool YamlReader::Node::isScalar() const {
  return defined() && data_->node().kind == YamlNode::Kind::kScalar;
}

YamlReader::Node YamlReader::Node::optional(const std::string& key) const {
  if (!defined()) return *this;
  auto& state = *data_->state;
  if (!isMap()) {
    // The map that should be here is asked for many keys; one problem is enough.
    if (state.asked.try_emplace(data_->index).second) problem("expected keys with values");
    return Node(nullptr);
  }
  state.asked[data_->index].insert(key);
  const std::size_t child = state.document.find(data_->index, key);
  if (child == state.document.nodes.size()) return Node(nullptr);
  return Node(std::make_shared<const Data>(Data{data_->state, child, key}));
}

YamlReader::Node YamlReader::Node::required(const std::string& key) const {
  Node member = optional(key);
  if (!member.defined() && isMap()) problem("\"" + key + "\" is missing");
  return member;
}

void YamlReader::Node::refuseUnknownKeys() const {
  if (!isMap()) return;
  auto& state = *data_->state;
  const auto& known = state.asked[data_->index];
  for (const std::size_t child : data_->node().children) {
    const YamlNode& member = state.document.nodes[child];
    if (known.contains(member.key)) continue;
    if (state.document.problems.size() > kMaxProblems) return;
    const std::string suggestion = nearestWord(member.key, known);
    state.document.note({state.file, member.keyLine, member.keyColumn,
                         "unknown key " + quotedForMessage(member.key) +
                             (suggestion.empty() ? "" : "; did you mean \"" + suggestion + "\"?")});
  }
}

std::size_t YamlReader::Node::size() const {
  return defined() ? data_->node().children.size() : 0;
}

YamlReader::Node YamlReader::Node::at(std::size_t index) const {
  if (index >= size()) return Node(nullptr);
  return Node(std::make_shared<const Data>(Data{data_->state, data_->node().children[index], data_->name}));
}

std::vector<std::string> YamlReader::Node::keys() const {
  std::vector<std::string> keys;
  if (!defined()) return keys;
  if (!isMap()) {
    problem("expected keys with values");
    return keys;
  }
  auto& known = data_->state->asked[data_->index];
  for (const std::size_t child : data_->node().children) {
    keys.push_back(data_->state->document.nodes[child].key);
    known.insert(keys.back());
  }
  return keys;
}

std::vector<YamlReader::Node> YamlReader::Node::elements(std::size_t minimum, std::size_t maximum) const {
  std::vector<Node> elements;
  if (!defined()) return elements;
  const std::string wanted =
      minimum == maximum ? std::to_string(minimum) : std::to_string(minimum) + " to " + std::to_string(maximum);
  if (!isSequence()) {
    problem("expected a list of " + wanted);
  } else if (size() < minimum || size() > maximum) {
    problem("expected a list of " + wanted + ", found " + std::to_string(size()));
  } else {
    elements.reserve(size());
    for (std::size_t i = 0; i < size(); ++i) elements.push_back(at(i));
  }
  return elements;
}

std::string YamlReader::Node::text() const {
  if (!defined()) return {};
  if (!isScalar()) {
    problem("expected a text");
    return {};
  }
  return data_->node().text;
}

double YamlReader::Node::number(double minimum, double maximum) const {
  const double harmless = std::clamp(0.0, minimum, maximum);
  if (!defined()) return harmless;
  const auto value = isScalar() ? parseWhole<double>(data_->node().text) : std::nullopt;
  if (value && std::isfinite(*value) && *value >= minimum && *value <= maximum) return *value;
  problem("expected a number" + rangeText(minimum, maximum) +
          (isScalar() ? ", found " + quotedForMessage(data_->node().text) : ""));
  return harmless;
}

int YamlReader::Node::integer(int minimum, int maximum) const {
  const int harmless = std::clamp(0, minimum, maximum);
  if (!defined()) return harmless;
  const auto value = isScalar() ? parseWhole<int>(data_->node().text) : std::nullopt;
  if (value && *value >= minimum && *value <= maximum) return *value;
  problem("expected a whole number" + rangeText(minimum, maximum) +
          (isScalar() ? ", found " + quotedForMessage(data_->node().text) : ""));
  return harmless;
}

bool YamlReader::Node::boolean() const {
  if (!defined()) return false;
  const std::string value = isScalar() ? data_->node().text : "";
  if (value != "true" && value != "false") problem("expected true or false");
  return value == "true";
}

std::vector<double> YamlReader::Node::numbers(std::size_t count) const {
  return numbers(count, -kInfinity, kInfinity);
}

std::vector<double> YamlReader::Node::numbers(std::size_t count, double minimum, double maximum) const {
  std::vector<double> values(count, std::clamp(0.0, minimum, maximum));
  const auto nodes = elements(count, count);
  for (std::size_t i = 0; i < nodes.size(); ++i) values[i] = nodes[i].number(minimum, maximum);
  return values;
}

void YamlReader::Node::problem(const std::string& message) const {
  if (!defined()) return;
  const YamlNode& node = data_->node();
  const std::string prefix = data_->name.empty() ? "" : data_->name + ": ";
  data_->state->document.note({data_->state->file, node.line, node.column, prefix + message});
}

YamlReader::YamlReader(std::string_view text, std::string file) : state_(std::make_shared<State>()) {
  state_->file = std::move(file);
  state_->document = parseYaml(text, state_->file);
}

YamlReader::~YamlReader() = default;

YamlReader::Node YamlReader::root() const {
  if (!state_->document.hasRoot()) return Node(nullptr);
  return Node(std::make_shared<const Node::Data>(Node::Data{state_, 0, ""}));
}

const std::vector<Problem>& YamlReader::problems() const {
  return state_->document.problems;
}

void YamlReader::throwIfProblems() const {
  if (problems().empty()) return;
  auto ordered = problems();
  std::ranges::stable_sort(ordered, {}, [](const Problem& problem) { return std::pair(problem.line, problem.column); });
  throw StoreError(std::move(ordered));
}

int YamlReader::readHeader(const std::string& format, int newestVersion) const {
  const Node top = root();
  const Node written = top.isMap() ? top.optional("format") : top;
  if (!top.isMap() || !written.isScalar() || written.text() != format) {
    (written.defined() ? written : top).problem("this is not a " + format + " file: no \"format: " + format + "\"");
    throwIfProblems();
  }
  const int version = top.required("version").integer(0, std::numeric_limits<int>::max());
  if (version > newestVersion) {
    top.optional("version").problem("written by a newer PixelFlex (version " + std::to_string(version) +
                                    ", this program knows up to " + std::to_string(newestVersion) + ")");
    throwIfProblems();
  }
  return version;
}

void YamlReader::moveMember(const std::string& from, const std::string& to) {
  if (state_->document.hasRoot()) state_->document.moveMember(from, to);
}

}  // namespace pixelflex::calib

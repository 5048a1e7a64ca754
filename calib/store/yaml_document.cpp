#include "calib/store/yaml_document.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <optional>
#include <sstream>
#include <unordered_set>
#include <utility>

namespace pixelflex::calib {
namespace {

/// Leaves the parser after a problem that has been noted.
struct Stop {};

struct Place {
  int line = 1;
  int column = 1;
};

bool isContinuation(unsigned char byte) {
  return (byte & 0xC0U) == 0x80U;
}

/// The length of the UTF-8 sequence at the start of `text`; 0 when there is none (overlong, surrogate, cut off).
std::size_t utf8Length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xC2 && first <= 0xDF   ? 2
                             : first >= 0xE0 && first <= 0xEF ? 3
                             : first >= 0xF0 && first <= 0xF4 ? 4
                                                              : 0;
  if (length == 0 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if (!isContinuation(byte(i))) return 0;
  }
  const unsigned char second = byte(1);
  const bool overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
  const bool beyond = (first == 0xED && second > 0x9F) || (first == 0xF4 && second > 0x8F);
  return overlong || beyond ? 0 : length;
}

/// Refuses bytes that yaml-cpp would take for an end of file, another encoding or nothing in particular.
std::optional<std::string> problemOfCharacter(std::string_view rest, bool inIndentation) {
  const auto first = static_cast<unsigned char>(rest[0]);
  if (first == '\t' && inIndentation) return "a tab in the indentation: YAML wants spaces";
  if (first == 0) return "a NUL byte: this is not a text file";
  const bool blank = first == '\t' || first == '\n' || first == '\r';
  if ((first < 0x20 && !blank) || first == 0x7F) return "a control character: this is not a text file";
  if (utf8Length(rest) == 0) return "not valid UTF-8";
  return std::nullopt;
}

bool isStructure(char c) {
  return std::string_view("[]{},:-?\n").find(c) != std::string_view::npos;
}

/// Looks at every character before the parser does. The first problem is enough.
std::optional<Problem> problemOfText(std::string_view text, const std::string& file) {
  if (text.size() > kMaxStoreBytes) return Problem{file, 0, 0, "larger than 64 MiB"};
  Place place;
  bool inIndentation = true;
  std::size_t structure = 0;
  for (std::size_t i = 0; i < text.size(); ++place.column) {
    if (auto message = problemOfCharacter(text.substr(i), inIndentation)) {
      return Problem{file, place.line, place.column, *message};
    }
    const char c = text[i];
    structure += isStructure(c) ? 1U : 0U;
    inIndentation = c == '\n' || (inIndentation && c == ' ');
    if (c == '\n') place = {place.line + 1, 0};
    i += utf8Length(text.substr(i));
  }
  if (structure > 2 * kMaxYamlNodes) return Problem{file, 0, 0, "has more parts than any wall could need"};
  return std::nullopt;
}

/// Turns the parser's events into nodes.
class Builder : public YAML::EventHandler {
 public:
  Builder(YamlDocument& document, const std::string& file) : document_(document), file_(file) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ > 1) stop(mark, "a second document: one file holds one");
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    add(mark, "", anchor, YamlNode::Kind::kNull, "");
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { stop(mark, "aliases are not supported"); }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    add(mark, tag, anchor, YamlNode::Kind::kScalar, value);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(mark, tag, anchor, YamlNode::Kind::kSequence);
  }
  void OnSequenceEnd() override { open_.pop_back(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(mark, tag, anchor, YamlNode::Kind::kMap);
  }
  void OnMapEnd() override { open_.pop_back(); }

 private:
  struct Key {
    std::string text;
    int line = 0;
    int column = 0;
  };
  struct Open {
    std::size_t node = 0;
    std::optional<Key> key;  // of a map: read, its value not yet
    std::unordered_set<std::string> keys;
  };

  [[noreturn]] void stop(const YAML::Mark& mark, const std::string& message) {
    document_.note({file_, mark.line + 1, mark.column + 1, message});
    throw Stop{};
  }

  void refuse(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    if (anchor != YAML::NullAnchor) stop(mark, "anchors are not supported");
    if (!tag.empty() && tag != "?" && tag != "!") stop(mark, "tags are not supported");
    if (document_.nodes.size() >= kMaxYamlNodes) stop(mark, "has more parts than any wall could need");
    if (open_.size() >= kMaxYamlDepth) stop(mark, "nested too deeply");
  }

  void takeKey(const YAML::Mark& mark, YamlNode::Kind kind, const std::string& text) {
    if (kind != YamlNode::Kind::kScalar) stop(mark, "a key must be plain text");
    Open& map = open_.back();
    if (!map.keys.insert(text).second) {
      document_.note({file_, mark.line + 1, mark.column + 1, "the key " + quotedForMessage(text) + " is given twice"});
    }
    map.key = Key{text, mark.line + 1, mark.column + 1};
  }

  void add(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, YamlNode::Kind kind,
           const std::string& text) {
    refuse(mark, tag, anchor);
    const bool inMap = !open_.empty() && document_.nodes[open_.back().node].kind == YamlNode::Kind::kMap;
    if (inMap && !open_.back().key) return takeKey(mark, kind, text);
    YamlNode node;
    node.kind = kind;
    node.line = mark.line + 1;
    node.column = mark.column + 1;
    node.text = text;
    if (auto key = inMap ? std::exchange(open_.back().key, std::nullopt) : std::nullopt) {
      node.key = std::move(key->text);
      node.keyLine = key->line;
      node.keyColumn = key->column;
    }
    if (!open_.empty()) document_.nodes[open_.back().node].children.push_back(document_.nodes.size());
    document_.nodes.push_back(std::move(node));
  }

  void open(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, YamlNode::Kind kind) {
    add(mark, tag, anchor, kind, "");
    open_.push_back({.node = document_.nodes.size() - 1, .key = std::nullopt, .keys = {}});
  }

  YamlDocument& document_;
  const std::string& file_;
  std::vector<Open> open_;
  int documents_ = 0;
};

void build(YamlDocument& document, std::string_view text, const std::string& file) {
  std::istringstream stream{std::string(text)};
  YAML::Parser parser(stream);
  Builder builder(document, file);
  while (parser.HandleNextDocument(builder)) {
  }
  if (!document.hasRoot()) document.note({file, 0, 0, "the file is empty"});
}

std::vector<std::string> splitPath(std::string_view path) {
  std::vector<std::string> keys;
  std::istringstream stream{std::string(path)};
  for (std::string key; std::getline(stream, key, '.');) keys.push_back(key);
  return keys;
}

/// An empty map as a member of `parent`, placed in messages where `like` is.
void addMap(YamlDocument& document, std::size_t parent, const std::string& key, std::size_t like) {
  if (document.nodes[parent].kind != YamlNode::Kind::kMap) return;
  YamlNode map;
  map.kind = YamlNode::Kind::kMap;
  map.key = key;
  map.line = map.keyLine = document.nodes[like].line;
  map.column = map.keyColumn = document.nodes[like].column;
  document.nodes[parent].children.push_back(document.nodes.size());
  document.nodes.push_back(std::move(map));
}

}  // namespace

std::size_t YamlDocument::find(std::size_t map, std::string_view key) const {
  if (map >= nodes.size() || nodes[map].kind != YamlNode::Kind::kMap) return nodes.size();
  const auto& children = nodes[map].children;
  const auto found = std::ranges::find_if(children, [&](std::size_t child) { return nodes[child].key == key; });
  return found == children.end() ? nodes.size() : *found;
}

void YamlDocument::moveMember(std::string_view from, std::string_view to) {
  const auto source = splitPath(from);
  const auto target = splitPath(to);
  std::size_t parent = 0;
  std::size_t member = 0;
  for (const auto& key : source) {
    parent = std::exchange(member, find(member, key));
    if (member == nodes.size()) return;
  }
  std::size_t map = 0;
  for (std::size_t i = 0; i + 1 < target.size(); ++i) {
    if (map < nodes.size() && find(map, target[i]) == nodes.size()) addMap(*this, map, target[i], member);
    map = find(map, target[i]);
  }
  if (map == nodes.size() || nodes[map].kind != YamlNode::Kind::kMap || find(map, target.back()) != nodes.size()) {
    return;  // given in both spellings: the old one stays where it is and is refused as unknown
  }
  std::erase(nodes[parent].children, member);
  nodes[member].key = target.back();
  nodes[map].children.push_back(member);
}

void YamlDocument::note(Problem problem) {
  if (problems.size() > kMaxProblems) return;
  if (problems.size() == kMaxProblems) problem.message = "and more problems, not listed";
  problems.push_back(std::move(problem));
}

YamlDocument parseYaml(std::string_view text, const std::string& file) {
  YamlDocument document;
  if (auto problem = problemOfText(text, file)) {
    document.note(std::move(*problem));
    return document;
  }
  try {
    build(document, text, file);
    return document;
  } catch (const Stop&) {  // noted already
  } catch (const YAML::Exception& error) {
    const bool placed = !error.mark.is_null();
    document.note(
        {file, placed ? error.mark.line + 1 : 0, placed ? error.mark.column + 1 : 0, "not valid YAML: " + error.msg});
  }
  document.nodes.clear();
  return document;
}

std::string quotedForMessage(std::string_view text) {
  std::size_t length = std::min<std::size_t>(text.size(), 60);
  while (length < text.size() && isContinuation(static_cast<unsigned char>(text[length]))) --length;
  std::string shown = "\"";
  for (const char c : text.substr(0, length)) shown += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  return shown + (length < text.size() ? "…\"" : "\"");
}

}  // namespace pixelflex::calib

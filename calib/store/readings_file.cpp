#include "calib/store/readings_file.h"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>

#include "calib/store/yaml_document.h"
#include "calib/store/yaml_reader.h"

namespace pixelflex::calib {
namespace {

constexpr int kRows = 256;

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::optional<double> parseNumber(std::string_view text) {
  text = trimmed(text);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc{} && end == text.data() + text.size();
  return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::vector<std::string_view> cellsOf(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    cells.push_back(line.substr(begin, end - begin));
    begin = end + 1;
  }
  return cells;
}

/// What is wrong with the row that should be `expected`; empty when nothing is.
std::string problemOfRow(std::string_view line, int expected) {
  const auto cells = cellsOf(line);
  if (cells.size() != 4) return "expected four columns value,red,green,blue, found " + std::to_string(cells.size());
  std::array<double, 4> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto value = parseNumber(cells[i]);
    if (!value) return "expected a number, found " + quotedForMessage(trimmed(cells[i]));
    values.at(i) = *value;
    if (*value < 0) return "light cannot be negative: " + quotedForMessage(trimmed(cells[i]));
  }
  if (values[0] == expected) return "";
  return "expected the reading of value " + std::to_string(expected) + ", found " + quotedForMessage(trimmed(cells[0]));
}

}  // namespace

std::vector<Problem> checkReadings(const std::filesystem::path& file) {
  std::vector<Problem> problems;
  std::istringstream text(readStoreFile(file.string()));
  int lineNumber = 0;
  int rows = 0;
  for (std::string line; std::getline(text, line);) {
    ++lineNumber;
    if (trimmed(line).empty()) continue;
    if (rows == 0 && lineNumber == 1 && !parseNumber(cellsOf(line).front())) continue;  // the header
    if (rows == kRows) {
      problems.push_back({file.string(), lineNumber, 0, "more than 256 readings"});
      return problems;
    }
    const std::string message = problemOfRow(line, rows++);
    if (!message.empty()) problems.push_back({file.string(), lineNumber, 0, message});
  }
  if (rows < kRows) {
    problems.push_back({file.string(), 0, 0, "expected 256 readings, found " + std::to_string(rows)});
  }
  return problems;
}

}  // namespace pixelflex::calib

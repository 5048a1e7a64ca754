#include "calib/store/readings_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "calib/store/yaml_document.h"
#include "calib/store/yaml_reader.h"

namespace pixelflex::calib {
namespace {

constexpr std::size_t kRows = 256;
constexpr std::array<std::string_view, 4> kColumns = {"value", "red", "green", "blue"};

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::optional<double> parseNumber(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc{} && end == text.data() + text.size();
  return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::vector<std::string_view> cellsOf(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    cells.push_back(trimmed(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  return cells;
}

std::string wrongColumns(std::size_t found) {
  return "expected four columns value,red,green,blue, found " + std::to_string(found);
}

std::string lowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

/// A header with swapped colours would swap the channels without a word.
std::string problemOfHeader(const std::vector<std::string_view>& cells) {
  if (cells.size() != kColumns.size()) return wrongColumns(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string name = lowerCase(cells[i]);
    const auto* const known = std::ranges::find(kColumns, name);
    if (known != kColumns.end() && *known != kColumns.at(i)) {
      return "expected the columns in the order value,red,green,blue, found " + quotedForMessage(cells[i]) +
             " in column " + std::to_string(i + 1);
    }
  }
  return "";
}

/// Puts the row's light to its code, or says what is wrong with it.
std::string readRow(const std::vector<std::string_view>& cells, std::size_t code, Readings& readings) {
  if (cells.size() != kColumns.size()) return wrongColumns(cells.size());
  std::array<double, 4> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto value = parseNumber(cells[i]);
    if (!value) return "expected a number, found " + quotedForMessage(cells[i]);
    if (*value < 0) return "light cannot be negative: " + quotedForMessage(cells[i]);
    values.at(i) = *value;
  }
  if (values[0] != static_cast<double>(code)) {
    return "expected the reading of value " + std::to_string(code) + ", found " + quotedForMessage(cells[0]);
  }
  for (std::size_t c = 0; c < 3; ++c) readings.light.at(c).at(code) = values.at(c + 1);
  return "";
}

}  // namespace

Readings readReadings(std::string_view csv, const std::string& file) {
  Readings readings;
  int line = 0;
  std::size_t rows = 0;
  const auto report = [&](const std::string& message) {
    if (!message.empty()) readings.problems.push_back({file, line, 0, message});
  };
  if (csv.starts_with("\xEF\xBB\xBF")) csv.remove_prefix(3);  // spreadsheets write a byte order mark
  bool headerMayCome = true;
  while (!csv.empty()) {
    const std::size_t end = std::min(csv.find('\n'), csv.size());
    const std::string_view text = trimmed(csv.substr(0, end));
    csv.remove_prefix(std::min(end + 1, csv.size()));
    ++line;
    if (text.empty() || text.front() == '#') continue;
    const auto cells = cellsOf(text);
    if (std::exchange(headerMayCome, false) &&
        std::ranges::none_of(cells, [](auto cell) { return parseNumber(cell).has_value(); })) {
      report(problemOfHeader(cells));
      continue;
    }
    if (rows == kRows) {
      report("more than 256 readings");
      return readings;
    }
    readings.line.at(rows) = line;
    report(readRow(cells, rows, readings));
    ++rows;
  }
  line = 0;
  if (rows < kRows) report("expected 256 readings, found " + std::to_string(rows));
  return readings;
}

std::vector<Problem> checkReadings(const std::filesystem::path& file) {
  return readReadings(readStoreFile(file.string()), file.string()).problems;
}

}  // namespace pixelflex::calib

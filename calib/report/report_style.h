#pragma once

namespace pixelflex::calib {

/// The page up to its body: title, style sheet for screens of any width, light and dark, and A4 paper. %TITLE% stands
/// where the wall's name belongs.
extern const char* const kReportHead;

/// Patterns that drawings share.
extern const char* const kReportPatterns;

}  // namespace pixelflex::calib

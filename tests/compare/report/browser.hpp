#pragma once

#include <cstdint>
#include <string>
#include <vector>

/// Pages in a real browser.
namespace tandem::test {

struct BrowserOutcome {
  std::vector<std::string> failures;  ///< of the script's checks
  std::vector<std::string> errors;    ///< what the page and its console complained of
  std::uint32_t checks = 0;           ///< that were made
};

/// Opens a copy of the page from disk in Chromium without a window, 1200 x 900 pixels, and runs the body of an async
/// function in it, for which there are
///   check(condition, words)      a check that must hold
///   page                         what window.report gives
///   byId(id), text(id)           an element, its text
///   press(key, target)           a key goes down; target: the document's body unless given
///   change(id, value)            a control gets another value, as when a user sets it
///   pointer(type, x, y)          an event of the pointer over the images, in pixels from their top left
///   wait(milliseconds)           of the page's clock, which runs ahead when nothing happens
/// Fails the test when there is no Chromium, or the script does not come to its end.
BrowserOutcome run_in_browser(const std::string& page, const std::string& script);

}  // namespace tandem::test

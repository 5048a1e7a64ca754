#pragma once

#include <string_view>

namespace pixelflex::testing {

/// Feeds a text to every reader of the store. What parses must survive a round trip; whatever else happens but a
/// StoreError is a bug and leaves as another exception or an abort.
void readAsEveryStoreFile(std::string_view text);

}  // namespace pixelflex::testing

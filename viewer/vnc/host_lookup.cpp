#include "viewer/vnc/host_lookup.h"

#include <netdb.h>
#include <poll.h>

#include <cstring>
#include <memory>
#include <mutex>
#include <thread>

#include "viewer/vnc/session_error.h"

namespace pixelflex::viewer {
namespace {

struct Answer {
  int error = 0;
  std::vector<HostAddress> addresses;
};

Answer ask(const std::string& host, int port, int flags) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = flags | AI_NUMERICSERV;
  addrinfo* list = nullptr;
  Answer answer;
  answer.error = ::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &list);
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owner(answer.error == 0 ? list : nullptr, &::freeaddrinfo);
  for (const addrinfo* info = owner.get(); info != nullptr; info = info->ai_next) {
    HostAddress& address = answer.addresses.emplace_back();
    std::memcpy(&address.storage, info->ai_addr, info->ai_addrlen);
    address.length = info->ai_addrlen;
  }
  return answer;
}

// Shared by the session and the thread that asks; whoever leaves last frees it.
struct Lookup {
  Signal done;
  std::mutex mutex;
  Answer answer;
};

Answer askInBackground(const std::string& host, int port, Deadline deadline, const Signal& stop) {
  const auto lookup = std::make_shared<Lookup>();
  std::thread([lookup, host, port] {
    Answer answer = ask(host, port, 0);
    const std::lock_guard lock(lookup->mutex);
    lookup->answer = std::move(answer);
    lookup->done.raise();
  }).detach();
  if (!waitFor(lookup->done.fd(), POLLIN, deadline, stop)) {
    throw SessionError(CloseKind::kUnreachable, "the name of host " + host + " could not be looked up in time");
  }
  const std::lock_guard lock(lookup->mutex);
  return std::move(lookup->answer);
}

}  // namespace

std::vector<HostAddress> lookUpHost(const std::string& host, int port, Deadline deadline, const Signal& stop) {
  Answer answer = ask(host, port, AI_NUMERICHOST);
  if (answer.error != 0) answer = askInBackground(host, port, deadline, stop);
  if (answer.error != 0 || answer.addresses.empty()) {
    throw SessionError(CloseKind::kUnreachable,
                       "cannot find host " + host + " (" + ::gai_strerror(answer.error) + "): check its name");
  }
  return std::move(answer.addresses);
}

}  // namespace pixelflex::viewer

#include "devices/transport/line.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <cassert>
#include <future>
#include <utility>

#include "devices/transport/line_engine.h"
#include "devices/transport/line_loop.h"

namespace pixelflex::devices {

ReplyEnd untilText(std::string terminator) {
  return [terminator = std::move(terminator)](std::string_view received) -> std::optional<std::size_t> {
    const auto at = received.find(terminator);
    if (at == std::string_view::npos) return std::nullopt;
    return at + terminator.size();
  };
}

Line::Line(LineLoop& loop, LineAddress address, LineOptions options)
    : loop_(&loop), engine_(std::make_shared<Engine>(loop.context(), std::move(address), std::move(options))) {}

Line::~Line() {
  loop_->invoke([this] { engine_->shut(); });
}

std::string Line::ask(Exchange exchange) {
  assert(!loop_->isOwnThread());
  const auto promise = std::make_shared<std::promise<Answer>>();
  auto answer = promise->get_future();
  submit(std::move(exchange), [promise](Answer reply) { promise->set_value(std::move(reply)); });
  Answer reply = answer.get();
  if (const auto* problem = std::get_if<LineProblem>(&reply)) throw LineError(*problem);
  return std::get<std::string>(std::move(reply));
}

void Line::submit(Exchange exchange, std::function<void(Answer)> done) {
  boost::asio::post(engine_->context(),
                    [engine = engine_, exchange = std::move(exchange), done = std::move(done)]() mutable {
                      engine->enqueue(std::move(exchange), std::move(done));
                    });
}

void Line::disconnect() {
  loop_->invoke([this] { engine_->disconnect(); });
}

std::uint64_t Line::session() const {
  return engine_->sessions;
}

bool Line::isConnected() const {
  return engine_->connected;
}

const LineAddress& Line::address() const {
  return engine_->address();
}

std::string Line::name() const {
  return engine_->name();
}

}  // namespace pixelflex::devices

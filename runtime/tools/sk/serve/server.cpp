// SPDX-License-Identifier: MIT
//
// Whoever can name this machine can send requests to its ports, pages of strangers in the user's browser among them. Answers go to
// pages of this server alone: the Host header must name it, which a name that an attacker's DNS turns to 127.0.0.1 does not; the
// Origin header, where there is one, too; and programs have a media type for which browsers ask first, and get no leave.
#include "serve/server.hpp"

#include <atomic>
#include <chrono>
#include <csignal>
#include <exception>
#include <random>
#include <semaphore>
#include <stdexcept>
#include <thread>

#include <fmt/format.h>

#include <httplib.h>
#include <sys/socket.h>

#include "serve/own_host.hpp"

namespace sk_tool {
namespace {

constexpr std::size_t largestBody = std::size_t{256} << 10;
constexpr std::ptrdiff_t compilationsAtOnce = 2;
constexpr std::chrono::seconds longestWait{20};
constexpr const char* host = "127.0.0.1";
constexpr const char* plainText = "text/plain; charset=utf-8";
constexpr const char* programType = "text/x-streamkernel";

void refuse(httplib::Response& response, int status, const std::string& why) {
  response.status = status;
  response.set_content(why + "\n", plainText);
  response.set_header("Connection", "close");  // a body that nobody has read may follow
}

/// Whether the request comes from a page of this server, or from no page. Else it is answered.
bool isAllowed(const httplib::Request& request, httplib::Response& response, int port) {
  if (request.get_header_value_count("Host") != 1 || !isOwnHost(request.get_header_value("Host"), port)) {
    refuse(response, 403, fmt::format("this server answers to http://{}:{}/ only", host, port));
    return false;
  }
  if (!request.has_header("Origin")) return true;
  if (isOwnOrigin(request.get_header_value("Origin"), port)) return true;
  refuse(response, 403, "this server answers to its own pages only");
  return false;
}

std::string randomWord() {
  std::random_device source;
  return fmt::format("{:08x}{:08x}{:08x}{:08x}", source(), source(), source(), source());
}

/// The page's script tags carry a word that changes with each answer, so that no other script runs in it.
void answerPage(const Asset& page, httplib::Response& response) {
  const std::string word = randomWord(), mark = "@NONCE@";
  std::string text = page.text;
  for (std::size_t at = 0; (at = text.find(mark, at)) != std::string::npos;)
    text.replace(at, mark.size(), word);
  response.set_header(
      "Content-Security-Policy",
      fmt::format("default-src 'self'; script-src 'self' 'nonce-{}' blob:; style-src 'self' 'unsafe-inline'; "
                  "img-src 'self' data: blob:; frame-ancestors 'none'; base-uri 'none'; form-action 'none'",
                  word));
  response.set_content(text, page.type);
}

class Server {
 public:
  explicit Server(const Service& service) : service_(service) {}

  void run() {
    blockSignals();
    setUp();
    listen();
  }

 private:
  /// Before anything else, so that a signal which comes early also waits for the thread that takes it.
  void blockSignals() {
    ::sigemptyset(&signals_);
    for (const int signal : {SIGINT, SIGTERM}) ::sigaddset(&signals_, signal);
    ::pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
    std::signal(SIGPIPE, SIG_IGN);  // browsers that have gone
  }

  void setUp() {
    server_.new_task_queue = [] { return new httplib::ThreadPool(8); };
    server_.set_payload_max_length(largestBody);
    server_.set_keep_alive_timeout(5);
    server_.set_socket_options([](int socket) {  // httplib's own let several servers share a port
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    server_.set_default_headers({{"X-Content-Type-Options", "nosniff"},
                                 {"Referrer-Policy", "no-referrer"},
                                 {"Cross-Origin-Resource-Policy", "same-origin"},
                                 {"Cache-Control", "no-store"}});
    server_.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      using Handled = httplib::Server::HandlerResponse;
      return isAllowed(request, response, port_) ? Handled::Unhandled : Handled::Handled;
    });
    server_.set_exception_handler(
        [](const httplib::Request&, httplib::Response& response, std::exception_ptr thrown) {
          try {
            std::rethrow_exception(thrown);
          } catch (const std::exception& error) {
            refuse(response, 500, error.what());
          }
        });
    server_.set_error_handler([](const httplib::Request& request, httplib::Response& response) {
      if (!response.body.empty()) return;
      response.set_content(
          response.status == 413
              ? fmt::format("a program of the playground has at most {} kB\n", largestBody >> 10)
              : fmt::format("there is nothing at '{}'\n", request.path),
          plainText);
    });
    server_.Get("/start", [this](const httplib::Request&, httplib::Response& response) {
      response.set_content(service_.start(), "application/json");
    });
    server_.Get(".*", [this](const httplib::Request& request, httplib::Response& response) {
      answerFile(request, response);
    });
    server_.Post("/compile", [this](const httplib::Request& request, httplib::Response& response) {
      compile(request, response);
    });
  }

  void answerFile(const httplib::Request& request, httplib::Response& response) {
    const auto found = service_.assets.files.find(request.path == "/" ? "/index.html" : request.path);
    if (found == service_.assets.files.end()) {
      response.status = 404;
      return;
    }
    if (found->first == "/index.html") return answerPage(found->second, response);
    response.set_content(found->second.text, found->second.type.c_str());
  }

  void compile(const httplib::Request& request, httplib::Response& response) {
    if (request.get_header_value("Content-Type") != programType) {
      return refuse(response, 415, fmt::format("a program has the media type {}", programType));
    }
    if (!mayCompile_.try_acquire_for(longestWait)) {
      return refuse(response, 503, "other compilations take all the time that there is; try again later");
    }
    struct Release {
      std::counting_semaphore<>& semaphore;
      ~Release() { semaphore.release(); }
    } release{mayCompile_};
    response.set_content(service_.compile(request.body), "application/json");
  }

  void listen() {
    port_ = service_.port;
    if (port_ == 0)
      port_ = server_.bind_to_any_port(host);
    else if (!server_.bind_to_port(host, port_))
      port_ = -1;
    if (port_ <= 0) {
      throw std::runtime_error(
          fmt::format("port {} of {} is taken, or may not be had; give another one: --port N, or --port 0 "
                      "for one that is free",
                      service_.port, host));
    }
    std::atomic<bool> hasEnded = false;
    // Another thread takes the signals that end the server.
    std::thread stopper([&] {
      int signal = 0;
      ::sigwait(&signals_, &signal);
      // a server that does not run yet would not stop
      while (!hasEnded && !server_.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      server_.stop();
    });
    service_.started(fmt::format("http://{}:{}/", host, port_));
    server_.listen_after_bind();
    hasEnded = true;
    ::pthread_kill(stopper.native_handle(), SIGTERM);  // where the server has ended by itself
    stopper.join();
  }

  const Service& service_;
  httplib::Server server_;
  std::counting_semaphore<> mayCompile_{compilationsAtOnce};
  int port_ = 0;
  sigset_t signals_{};  ///< that end the server
};

}  // namespace

void serve(const Service& service) { Server(service).run(); }

}  // namespace sk_tool

#include "view/server.h"

#include "lamella/core/error.h"

#include <fmt/format.h>
#include <httplib.h>
#include <nlohmann/json.hpp>

#include "view/colors.h"
#include "view/page_files.h"
#include "view/run_process.h"
#include "view/run_view.h"
#include <charconv>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <random>
#include <thread>

namespace lamella::app::view {
namespace {

using httplib::Request;
using httplib::Response;

constexpr const char* kHost = "127.0.0.1";
constexpr const char* kJson = "application/json";
constexpr const char* kText = "text/plain; charset=utf-8";
constexpr const char* kBinary = "application/octet-stream";

enum Status { kRefused = 403, kNotFound = 404, kConflict = 409, kUnreadable = 422, kServerError = 500 };

/// As it is: cpp-httplib would compress what set_content() is given, 0.6 MB of page for three seconds, to cross a
/// loopback.
void answer(Response& response, const std::string& type, std::string content) {
    if (content.empty()) return response.set_content("", type);
    const auto shared = std::make_shared<const std::string>(std::move(content));  // the provider is copied
    response.set_content_provider(shared->size(), type,
                                  [shared](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
                                      return sink.write(shared->data() + offset, length);
                                  });
}

void answer_error(Response& response, int status, const std::string& text) {
    response.status = status;
    const nlohmann::json body{{"error", text}};
    response.set_content(body.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace), kJson);
}

/// The time that it takes does not tell how many characters are right.
bool same_secret(const std::string& a, const std::string& b) {
    unsigned difference = a.size() == b.size() ? 0u : 1u;
    for (std::size_t i = 0; i < a.size() && i < b.size(); ++i)
        difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
    return difference == 0;
}

std::optional<std::size_t> whole_number(const std::string& text) {
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
}

void answer_exception(Response& response, const std::exception_ptr& thrown) {
    try {
        std::rethrow_exception(thrown);
    } catch (const InputError& error) {
        answer_error(response, kUnreadable, error.what());
    } catch (const std::exception& error) {
        answer_error(response, kServerError, error.what());
    }
}

}  // namespace

struct Server::Impl {
    const RunView& run;
    std::string token;
    int port = 0;
    std::once_flag colors_made;
    std::string colors;  ///< of the first request for them on
    httplib::Server http;
    std::thread thread;

    Impl(const RunView& shown, std::string secret) : run(shown), token(std::move(secret)) {}

    bool is_own_name(const std::string& host) const {
        return host == fmt::format("127.0.0.1:{}", port) || host == fmt::format("localhost:{}", port);
    }

    /// Nothing for a request that may be served.
    std::optional<std::string> refusal(const Request& request) const {
        if (!is_own_name(request.get_header_value("Host")))
            return "this page is served on the loopback address only, under its own name";
        if (request.method == "GET" || request.method == "HEAD") return std::nullopt;
        const std::string origin = request.get_header_value("Origin");
        if (!origin.empty() && (!origin.starts_with("http://") || !is_own_name(origin.substr(7))))
            return "another page may not control this run";
        if (!same_secret(request.get_header_value("X-Lamella-Token"), token))
            return "to control the run, open the page with the whole address that lamella view printed";
        return std::nullopt;
    }

    void get(const std::string& path, const std::string& type, std::function<std::string(const Request&)> content) {
        http.Get(path, [type, content](const Request& request, Response& response) {
            answer(response, type, content(request));
        });
    }

    void control(const std::string& path, void (RunProcess::*action)()) {
        http.Post(path, [this, action](const Request&, Response& response) {
            RunProcess* process = run.process();
            if (process == nullptr || process->state() == RunProcess::State::kEnded)
                return answer_error(response, kConflict, "no run that this page started is going on");
            (process->*action)();
            answer(response, kJson, run.state());
        });
    }

    void add_routes() {
        for (const PageFile& file : page_files())
            get(std::string(file.path), std::string(file.type),
                [file](const Request&) { return std::string(file.content); });
        get("/api/state", kJson, [this](const Request&) { return run.state(); });
        get("/api/series", kJson, [this](const Request& request) {
            const std::string from = request.has_param("from") ? request.get_param_value("from") : "0";
            const auto first = whole_number(from);
            if (!first) throw InputError(fmt::format("from = \"{}\" is no row; give a whole number", from));
            return run.series(*first);
        });
        get("/api/scene", kText, [this](const Request&) { return run.scene(); });
        get("/api/provenance", kJson, [this](const Request&) { return run.provenance(); });
        get("/api/colors", kBinary, [this](const Request&) {
            std::call_once(colors_made, [this] { colors = color_message(); });
            return colors;
        });
        const auto frame_of = [](const Request& request) {
            const auto index = whole_number(request.matches[1]);
            if (!index) throw InputError("that is no number of a frame");
            return *index;
        };
        get(R"(/api/frames/(\d+))", kBinary, [=, this](const Request& r) { return run.frame(frame_of(r)); });
        get(R"(/api/frames/(\d+)/regions)", kJson, [=, this](const Request& r) { return run.regions(frame_of(r)); });
        control("/api/run/pause", &RunProcess::pause);
        control("/api/run/resume", &RunProcess::resume);
        control("/api/run/stop", &RunProcess::stop);
    }

    void set_policy() {
        constexpr std::size_t kLargestBody = 4096;  // nothing that is sent here needs a body
        http.set_payload_max_length(kLargestBody);
        http.set_keep_alive_timeout(1);  // the destructor waits for it
        http.set_default_headers(
            {{"Cache-Control", "no-store"},
             {"X-Content-Type-Options", "nosniff"},
             {"X-Frame-Options", "DENY"},
             {"Referrer-Policy", "no-referrer"},
             {"Cross-Origin-Resource-Policy", "same-origin"},
             {"Content-Security-Policy",
              "default-src 'self'; img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'"}});
        http.set_pre_routing_handler([this](const Request& request, Response& response) {
            const auto reason = refusal(request);
            if (!reason) return httplib::Server::HandlerResponse::Unhandled;
            answer_error(response, kRefused, *reason);
            return httplib::Server::HandlerResponse::Handled;
        });
        http.set_error_handler([](const Request& request, Response& response) {
            if (response.body.empty())
                answer_error(response, response.status,
                             response.status == kNotFound ? fmt::format("there is no {} here", request.path)
                                                          : "this request cannot be understood");
        });
        http.set_exception_handler(
            [](const Request&, Response& response, std::exception_ptr thrown) { answer_exception(response, thrown); });
    }
};

Server::Server(const RunView& run, std::string token, int port) : impl_(std::make_unique<Impl>(run, std::move(token))) {
    impl_->set_policy();
    impl_->add_routes();
    const bool bound = port == 0 ? (impl_->port = impl_->http.bind_to_any_port(kHost)) > 0
                                 : impl_->http.bind_to_port(kHost, impl_->port = port);
    if (!bound) throw IoError(fmt::format("port {} of {} is taken; give another with --port", port, kHost));
    impl_->thread = std::thread([this] { impl_->http.listen_after_bind(); });
    while (!impl_->http.is_running()) std::this_thread::yield();  // stop() before that would be lost
}

Server::~Server() {
    impl_->http.stop();
    impl_->thread.join();
}

int Server::port() const { return impl_->port; }

std::string new_token() {
    std::random_device bits;
    std::string token;
    for (int i = 0; i < 4; ++i) token += fmt::format("{:08x}", bits());
    return token;
}

}  // namespace lamella::app::view

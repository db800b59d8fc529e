#pragma once

#include <memory>
#include <string>

namespace lamella::app::view {

class RunView;

/// Serves a run and the page that shows it, on the loopback address only.
///
///   GET  /, /page.js, /page.css              the page (page_files.h)
///   GET  /api/state, /api/series?from=ROW, /api/scene, /api/provenance
///   GET  /api/frames/N, /api/frames/N/regions
///   GET  /api/colors                         what films reflect (colors.h)
///   POST /api/run/pause, resume, stop        need the header X-Lamella-Token
///
/// Requests under another host's name are refused: a page of the web that makes its own name point here (DNS rebinding)
/// reads nothing. Errors are JSON, {"error": "in words"}.
class Server {
public:
    /// @param port  0: any free one   @throws IoError  the port is taken
    Server(const RunView& run, std::string token, int port);
    ~Server();  ///< stops it and waits for the requests that it serves
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    int port() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// 128 random bits of the system, in hexadecimal digits.
std::string new_token();

}  // namespace lamella::app::view

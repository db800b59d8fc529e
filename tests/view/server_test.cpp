#include "view/server.h"

#include "lamella/io/frame_files.h"

#include <gtest/gtest.h>
#include <httplib.h>
#include <nlohmann/json.hpp>

#include "films.h"
#include "view/run_process.h"
#include "view/run_view.h"
#include <filesystem>
#include <fstream>
#include <string>

namespace lamella::app::view {
namespace {

namespace fs = std::filesystem;

const std::string kToken = "0123456789abcdef";

/// A run folder with three frames, of which the last is damaged, and a server that shows it.
class ServerTest : public testing::Test {
protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "lamella_view_XXXXXX").string();
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        outside = name;
        folder = outside / "run";
        fs::create_directories(folder / "frames");
        write("scene.toml",
              "title = \"three sheets\"\nsolver = \"equilibrium\"\n[material]\nthickness = 3e-07\n[[bubble]]\nradius = "
              "1.0\n");
        write("run.json",
              R"({"title": "three sheets", "solver": "equilibrium", "state": "finished", "time_unit": "s"})");
        write("series.csv", "time[s],energy[J]\n0,1\n1,nan\n2,3\n");
        io::write_vtp(folder / "frames/000000.vtp", three_sheets(4));
        io::write_vtp(folder / "frames/000001.vtp", three_sheets(4));
        write("frames/000002.vtp", "<VTKFile type=\"PolyData\">damaged");
        list({"frames/000000.vtp", "frames/000001.vtp", "frames/000002.vtp"});
    }
    void TearDown() override { fs::remove_all(outside); }

    void write(const std::string& name, const std::string& text) { std::ofstream(folder / name) << text; }
    void list(const std::vector<std::string>& files) {
        std::vector<io::FrameEntry> entries;
        for (const std::string& file : files) entries.push_back({double(entries.size()), file});
        io::write_pvd(folder / "frames.pvd", entries);
    }

    void expect_error(const httplib::Result& result, int status, const std::string& words) {
        ASSERT_TRUE(result);
        EXPECT_EQ(result->status, status) << result->body;
        const nlohmann::json body = nlohmann::json::parse(result->body, nullptr, false);
        ASSERT_TRUE(body.is_object()) << result->body;
        EXPECT_NE(body.at("error").get<std::string>().find(words), std::string::npos) << result->body;
    }

    fs::path outside, folder;
};

TEST_F(ServerTest, CompressesNothing) {
    const RunView run(folder, nullptr);
    const Server server(run, kToken, 0);
    httplib::Client client("127.0.0.1", server.port());
    client.set_decompress(false);
    for (const char* path : {"/", "/page.js", "/api/state", "/api/series", "/api/scene", "/api/frames/0"}) {
        const auto result = client.Get(path, {{"Accept-Encoding", "gzip, deflate, br"}});
        ASSERT_TRUE(result) << path;
        if (result->status == 404) continue;  // a build without the page says so in a few words
        EXPECT_FALSE(result->has_header("Content-Encoding")) << path;
    }
}

TEST_F(ServerTest, AnswersWhatIsInTheFolder) {
    const RunView run(folder, nullptr);
    const Server server(run, kToken, 0);
    httplib::Client client("127.0.0.1", server.port());
    const auto state = nlohmann::json::parse(client.Get("/api/state")->body);
    EXPECT_EQ(state.at("title"), "three sheets");
    EXPECT_EQ(state.at("frame_times").size(), 3u);
    EXPECT_EQ(state.at("thickness"), 3e-7);
    EXPECT_EQ(state.at("controlled"), false);
    const auto series = nlohmann::json::parse(client.Get("/api/series?from=1")->body);
    EXPECT_EQ(series.at("columns")[1].at("unit"), "J");
    EXPECT_EQ(series.at("rows").size(), 2u);
    EXPECT_TRUE(series.at("rows")[0][1].is_null());
    EXPECT_EQ(client.Get("/api/frames/0")->body.substr(0, 4), "LMLA");
    EXPECT_NE(client.Get("/api/scene")->body.find("three sheets"), std::string::npos);
    EXPECT_EQ(nlohmann::json::parse(client.Get("/api/provenance")->body).at("state"), "finished");
}

TEST_F(ServerTest, SaysWhatIsWrongInWords) {
    const RunView run(folder, nullptr);
    const Server server(run, kToken, 0);
    httplib::Client client("127.0.0.1", server.port());
    expect_error(client.Get("/api/frames/2"), 422, "000002.vtp");
    expect_error(client.Get("/api/frames/3"), 422, "frames 0 to 2, no 3");
    expect_error(client.Get("/api/frames/99999999999999999999999"), 422, "number");
    expect_error(client.Get("/api/series?from=-1"), 422, "row");
    expect_error(client.Get("/nothing"), 404, "/nothing");
}

TEST_F(ServerTest, ReadsNothingOutsideTheFolder) {
    io::write_vtp(outside / "secret.vtp", three_sheets(1));
    fs::create_symlink(outside / "secret.vtp", folder / "frames/link.vtp");
    list({"../secret.vtp", (outside / "secret.vtp").string(), "frames/link.vtp", "frames/000000.vtp"});
    const RunView run(folder, nullptr);
    const Server server(run, kToken, 0);
    httplib::Client client("127.0.0.1", server.port());
    for (const char* frame : {"0", "1", "2"}) {
        expect_error(client.Get("/api/frames/" + std::string(frame)), 422, "outside the run folder");
        expect_error(client.Get("/api/frames/" + std::string(frame) + "/regions"), 422, "outside the run folder");
    }
    EXPECT_EQ(client.Get("/api/frames/3")->status, 200);
    for (const char* path : {"/../secret.vtp", "/api/../../secret.vtp", "/%2e%2e/secret.vtp",
                             "/api/frames/../../secret.vtp", "/api/frames/..%2f..%2fsecret.vtp", "/scene.toml"})
        EXPECT_EQ(client.Get(path)->status, 404) << path;
    fs::remove(folder / "scene.toml");
    fs::create_symlink(outside / "secret.vtp", folder / "scene.toml");
    expect_error(client.Get("/api/scene"), 422, "outside the run folder");
}

TEST_F(ServerTest, RefusesOtherNamesThanItsOwn) {
    const RunView run(folder, nullptr);
    const Server server(run, kToken, 0);
    httplib::Client client("127.0.0.1", server.port());
    expect_error(client.Get("/api/state", {{"Host", "evil.example"}}), 403, "loopback");
    expect_error(client.Get("/api/state", {{"Host", "evil.example:" + std::to_string(server.port())}}), 403,
                 "loopback");
    EXPECT_EQ(client.Get("/api/state", {{"Host", "localhost:" + std::to_string(server.port())}})->status, 200);
}

TEST_F(ServerTest, ControlsARunOnlyWithTheToken) {
    RunProcess process({"/bin/sleep", "60"});
    const RunView run(folder, &process);
    const Server server(run, kToken, 0);
    httplib::Client client("127.0.0.1", server.port());
    const auto post = [&](const std::string& action, const httplib::Headers& headers) {
        return client.Post("/api/run/" + action, headers, "", "text/plain");
    };
    expect_error(post("pause", {}), 403, "address");
    expect_error(post("pause", {{"X-Lamella-Token", "wrong"}}), 403, "address");
    expect_error(post("pause", {{"X-Lamella-Token", kToken.substr(1)}}), 403, "address");
    expect_error(post("pause", {{"X-Lamella-Token", kToken}, {"Origin", "http://evil.example"}}), 403, "another page");
    EXPECT_EQ(process.state(), RunProcess::State::kRunning);
    EXPECT_EQ(client.Get("/api/run/pause")->status, 404);  // a link cannot do it

    const httplib::Headers right{{"X-Lamella-Token", kToken}};
    EXPECT_EQ(nlohmann::json::parse(post("pause", right)->body).at("paused"), true);
    EXPECT_EQ(process.state(), RunProcess::State::kPaused);
    EXPECT_EQ(post("resume", right)->status, 200);
    EXPECT_EQ(process.state(), RunProcess::State::kRunning);
    EXPECT_EQ(post("stop", right)->status, 200);
    while (process.state() != RunProcess::State::kEnded) std::this_thread::yield();
    expect_error(post("pause", right), 409, "going on");
}

TEST_F(ServerTest, ControlsNothingThatItDidNotStart) {
    const RunView run(folder, nullptr);
    const Server server(run, kToken, 0);
    httplib::Client client("127.0.0.1", server.port());
    expect_error(client.Post("/api/run/stop", {{"X-Lamella-Token", kToken}}, "", "text/plain"), 409, "going on");
}

TEST(NewToken, IsNewEachTime) {
    EXPECT_EQ(new_token().size(), 32u);
    EXPECT_NE(new_token(), new_token());
}

}  // namespace
}  // namespace lamella::app::view

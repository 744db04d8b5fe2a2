#include "suites/worker_process.h"

#include <signal.h>

#include <atomic>
#include <thread>

#include <gtest/gtest.h>

#include "perception/base/atomic_file.h"
#include "perception/image_file.h"
#include "tests/places.h"
#include "tests/suites/test_suite.h"
#include "tests/temporary_folder.h"

namespace {

using results::Status;
using suites::WorkerAnswer;

class Workers : public testing::Test {
 protected:
  Workers() { tests::write_scene(folder_.path()); }

  suites::WorkerOptions options() const {
    suites::WorkerOptions made;
    made.executable = tests::kSuiteWorker;
    made.stdout_file = folder_.path() / "stdout.log";
    made.stderr_file = folder_.path() / "stderr.log";
    made.timeout_s = 30.0;
    return made;
  }
  suites::OpenJob open(const std::string& behaviour, double sleep_s = 0.0) const {
    suites::OpenJob job;
    job.scene_file = folder_.path() / "walls.yaml";
    job.size_px = {8, 8};
    job.renderer = "blank";
    job.preset = "best";
    job.parameters = {{"radiance", 0.5}, {"behaviour", behaviour}, {"sleep_s", sleep_s}};
    job.threads = 1;
    // A warm-up would misbehave before the repetition does.
    job.warmups = 0;
    return job;
  }
  suites::RenderOrder order(int repetition = 0) const {
    suites::RenderOrder made;
    made.repetition = repetition;
    made.image = folder_.path() / "frame.exr";
    return made;
  }
  WorkerAnswer answer_of(const std::string& behaviour) const {
    suites::WorkerProcess worker(options(), open(behaviour));
    return worker.render(order());
  }
  bool has_half_written_files() const {
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      if (entry.path().extension() == ".tmp") return true;
    }
    return false;
  }

  tests::TemporaryFolder folder_;
};

TEST_F(Workers, ServeRepetitionAfterRepetition) {
  suites::WorkerProcess worker(options(), open("normal"));
  const WorkerAnswer first = worker.render(order(0));
  ASSERT_TRUE(first.rendered.has_value()) << first.reason;
  EXPECT_EQ(first.status, Status::ok);
  EXPECT_FLOAT_EQ(perception::read_image(folder_.path() / "frame.exr").at(3, 3), 0.5F);

  // Pixels that are known already are not written again.
  std::filesystem::remove(folder_.path() / "frame.exr");
  suites::RenderOrder second = order(1);
  second.known_pixel_hash = first.rendered->record.pixel_hash;
  const WorkerAnswer again = worker.render(second);
  ASSERT_TRUE(again.rendered.has_value());
  EXPECT_EQ(again.rendered->record.pixel_hash, first.rendered->record.pixel_hash);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "frame.exr"));
  EXPECT_TRUE(worker.is_alive());
  EXPECT_GT(worker.resident_bytes(), 0);
  worker.close();
  EXPECT_FALSE(worker.is_alive());
}

TEST_F(Workers, ACrashIsAnAnswerWithItsSignal) {
  const WorkerAnswer answer = answer_of("crash");
  EXPECT_EQ(answer.status, Status::crash);
  EXPECT_EQ(answer.reason, "signal 6 (Aborted)");
  EXPECT_FALSE(answer.rendered.has_value());
}

TEST_F(Workers, ACrashInTheWarmUpIsAnAnswer) {
  suites::OpenJob job = open("crash");
  job.warmups = 1;
  suites::WorkerProcess worker(options(), job);
  EXPECT_EQ(worker.render(order()).reason, "signal 6 (Aborted)");
  EXPECT_FALSE(worker.is_alive());
}

TEST_F(Workers, AHangEndsAtTheTimeout) {
  suites::WorkerOptions made = options();
  made.timeout_s = 0.3;
  suites::WorkerProcess worker(made, open("hang"));
  const WorkerAnswer answer = worker.render(order());
  EXPECT_EQ(answer.status, Status::timeout);
  EXPECT_EQ(answer.reason, "no answer within 300 ms");
  EXPECT_FALSE(worker.is_alive());
}

TEST_F(Workers, TooMuchMemoryEndsAtTheLimit) {
  suites::WorkerOptions made = options();
  made.memory_bytes = std::int64_t{400} << 20;
  suites::WorkerProcess worker(made, open("allocate"));
  const WorkerAnswer answer = worker.render(order());
  EXPECT_EQ(answer.status, Status::out_of_memory) << answer.reason;
  EXPECT_NE(answer.reason.find("the limit is 400 MiB"), std::string::npos) << answer.reason;
}

TEST_F(Workers, AnExceptionLeavesTheWorkerAlive) {
  suites::WorkerProcess worker(options(), open("exception"));
  const WorkerAnswer answer = worker.render(order());
  ASSERT_TRUE(answer.rendered.has_value());
  EXPECT_EQ(answer.status, Status::crash);
  EXPECT_TRUE(worker.is_alive());
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "frame.exr"));
}

TEST_F(Workers, KillingAWorkerIsAnAnswer) {
  suites::WorkerProcess worker(options(), open("normal", 20.0));
  // Asked for here, as the worker is this thread's; it would be -1, which means everybody, once
  // gone.
  const pid_t pid = worker.pid();
  std::thread killer([pid] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    kill(pid, SIGKILL);
  });
  const WorkerAnswer answer = worker.render(order());
  killer.join();
  EXPECT_EQ(answer.status, Status::crash);
  EXPECT_EQ(answer.reason.find("signal 9 (Killed)"), 0U) << answer.reason;
  EXPECT_FALSE(has_half_written_files());
}

TEST(WorkerEnd, OfAKillSaysWhetherMemoryMayHaveBeenTheReason) {
  const base::ExitState killed{0, SIGKILL};
  const std::int64_t held_bytes = std::int64_t{3} << 30;
  const auto text_of = [](const suites::WorkerEnd& end) {
    return results::to_string(end.status) + ": " + end.reason;
  };
  EXPECT_EQ(text_of(suites::end_of(killed, 0, held_bytes)), "crash: signal 9 (Killed)");
  EXPECT_EQ(text_of(suites::end_of(killed, 1, held_bytes)),
            "out_of_memory: signal 9 (Killed), and the kernel killed for lack of memory "
            "meanwhile; its resident memory had reached 3.00 GiB");
  EXPECT_EQ(text_of(suites::end_of(killed, std::nullopt, held_bytes)),
            "crash: signal 9 (Killed), out of memory?; its resident memory had reached 3.00 GiB");
  EXPECT_EQ(text_of(suites::end_of(killed, std::nullopt, 0)),
            "crash: signal 9 (Killed), out of memory?");
  EXPECT_EQ(text_of(suites::end_of({0, SIGSEGV}, 1, held_bytes)),
            "crash: signal 11 (Segmentation fault)");
  EXPECT_EQ(text_of(suites::end_of({3, 0}, 1, held_bytes)), "crash: exit code 3");
}

TEST_F(Workers, AnInterruptStopsTheWorker) {
  suites::WorkerOptions made = options();
  std::atomic<bool> is_interrupted = false;
  made.is_interrupted = [&] { return is_interrupted.load(); };
  suites::WorkerProcess worker(made, open("hang"));
  std::thread user([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    is_interrupted = true;
  });
  const WorkerAnswer answer = worker.render(order());
  user.join();
  EXPECT_TRUE(answer.is_interrupted);
  EXPECT_FALSE(worker.is_alive());
}

TEST_F(Workers, ASceneThatCannotBeReadIsAnAnswerWithItsMessage) {
  base::write_text_file(folder_.path() / "walls.yaml", "schema: 1\nscene: a\ncamara: {}\n");
  const WorkerAnswer answer = answer_of("normal");
  EXPECT_EQ(answer.status, Status::crash);
  EXPECT_NE(answer.reason.find("walls.yaml:"), std::string::npos) << answer.reason;
}

TEST_F(Workers, LogsKeepTheFirstAndTheLastMegabyte) {
  answer_of("print");
  const auto size = std::filesystem::file_size(folder_.path() / "stdout.log");
  EXPECT_GE(size, std::uintmax_t{2} << 20);
  EXPECT_LT(size, (std::uintmax_t{2} << 20) + 200);
}

TEST_F(Workers, AProgramThatIsNoWorkerIsAnAnswer) {
  suites::WorkerOptions made = options();
  made.executable = "/bin/true";
  suites::WorkerProcess worker(made, open("normal"));
  const WorkerAnswer answer = worker.render(order());
  EXPECT_EQ(answer.status, Status::crash);
  EXPECT_EQ(answer.reason, "exit code 0");
}

TEST_F(Workers, ServeASequenceFrameByFrame) {
  suites::OpenJob job = open("normal");
  job.scene_file = folder_.path() / "moving.yaml";
  job.is_sequence = true;
  job.parameters.emplace_back("radiance_per_frame", 0.25);
  suites::WorkerProcess worker(options(), job);
  for (int frame = 0; frame < 3; ++frame) {
    suites::RenderOrder one = order();
    one.frame = frame;
    one.is_cold = frame == 0;
    one.is_last = frame == 2;
    one.image = folder_.path() / ("frame-" + std::to_string(frame) + ".exr");
    const WorkerAnswer answer = worker.render(one);
    ASSERT_TRUE(answer.rendered.has_value()) << answer.reason;
    EXPECT_EQ(answer.rendered->record.frame, frame);
    EXPECT_EQ(answer.rendered->record.next_frame_s.has_value(), frame > 0);
    EXPECT_FLOAT_EQ(perception::read_image(one.image).at(3, 3),
                    0.5F + 0.25F * static_cast<float>(frame));
  }
  // The sequence has ended: nothing can follow.
  suites::RenderOrder next = order();
  next.frame = 3;
  next.is_cold = false;
  const WorkerAnswer refused = worker.render(next);
  EXPECT_EQ(refused.status, Status::crash);
  EXPECT_EQ(refused.reason, "frame 3 follows no other: no sequence is under way");
  EXPECT_TRUE(worker.is_alive());
}

}  // namespace

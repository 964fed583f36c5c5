// Forks children in every way, from a parent that has drawn, draws, or will draw. A word selects the way. All results
// are printed in an order that the program enforces.
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <pthread.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/programs/processes/plain_drawing.hpp"

using namespace programs;

extern char** environ; // NOLINT(readability-redundant-declaration)

namespace {

constexpr int kPatienceS = 30;
constexpr int kHangS = 5; // for a child that hangs in Mesa's destructors, natively as well

pid_t startChild(const std::function<void()>& run, bool raw = false) {
    std::fflush(stdout);
    const auto pid = raw ? static_cast<pid_t>(syscall(SYS_fork)) : fork();
    if (pid < 0) fail("no child");
    if (pid != 0) return pid;
    alarm(kPatienceS);
    run();
    std::fflush(stdout);
    _exit(7); // without Mural, Mesa's destructors wait for the parent's threads
}

void awaitChild(pid_t pid) {
    int status = 0;
    waitpid(pid, &status, 0);
    std::printf("child: %s %d\n", WIFEXITED(status) ? "status" : "signal",
                WIFEXITED(status) ? WEXITSTATUS(status) : WTERMSIG(status));
    std::fflush(stdout);
}

// Makes calls that Mesa answers without its threads. Deleting and binding affect only the child's copy.
void callMuch() {
    GLint value = 0;
    GLuint name = 0;
    std::printf("errors %x %x\n", glGetError(), glGetError());
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &value);
    std::printf("renderer %d, current %d\n", glGetString(GL_RENDERER) != nullptr, glXGetCurrentContext() != nullptr);
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_2D, name);
    const uint32_t pixel = 0xff00ff00;
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, 1, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, &pixel);
    glDeleteTextures(1, &name);
    glNewList(7, GL_COMPILE);
    glBegin(GL_POINTS);
    glVertex2f(0, 0);
    glEnd();
    glEndList();
    glEnable(GL_BLEND);
    glPushAttrib(GL_ALL_ATTRIB_BITS);
    glPopAttrib();
    glMatrixMode(GL_MODELVIEW);
    glPushMatrix();
    glRotatef(30, 0, 0, 1);
    glPopMatrix();
    glGenQueries(1, &name);
    glDeleteQueries(1, &name);
    std::printf("list %d, enabled %d, error %x\n", glIsList(7), glIsEnabled(GL_BLEND), glGetError());
}

void calls(bool raw) {
    const Plain own = openGlx();
    drawFrames(own, 0, 3);
    awaitChild(startChild(callMuch, raw));
    awaitChild(startChild(
        [raw] { // through destructors and atexit; after a raw fork they wait for threads that the child has not
            if (raw) alarm(kHangS);
            std::exit(9);
        },
        raw));
    printFrame("parent", own, 3);
}

// Draws in both processes at the same time; the child prints first.
void together(bool raw, const std::function<Plain()>& open) {
    const Plain own = open();
    drawFrames(own, 0, 3);
    const pid_t child = startChild(
        [&] {
            const Plain childs = open();
            drawFrames(childs, 10, 5);
            printFrame("child", childs, 20);
            awaitChild(startChild(
                [&] {
                    const Plain grandchilds = open();
                    printFrame("grandchild", grandchilds, 30);
                },
                raw));
            printFrame("child", childs, 21);
        },
        raw);
    drawFrames(own, 3, 8);
    awaitChild(child);
    printFrame("parent", own, 11);
}

void before() {
    const pid_t child = startChild([] {
        const Plain childs = openGlx();
        drawFrames(childs, 0, 4);
        printFrame("child", childs, 4);
    });
    const Plain own = openGlx();
    drawFrames(own, 5, 4);
    awaitChild(child);
    printFrame("parent", own, 9);
}

void after() {
    const Plain own = openGlx();
    printFrame("parent", own, 0);
    glXMakeCurrent(own.display, None, nullptr);
    glXDestroyContext(own.display, own.context);
    XCloseDisplay(own.display);
    awaitChild(startChild([] { printFrame("child", openGlx(), 1); }));
    printFrame("parent", openGlx(), 2);
}

void executed() {
    const Plain own = openGlx();
    char name[] = "true";
    char* arguments[] = {name, nullptr};
    for (int i = 0; i < 3; ++i) {
        drawPlain(i);
        pid_t child = 0;
        if (i == 0) {
            posix_spawn(&child, "/bin/true", nullptr, nullptr, arguments, environ);
        } else if (i == 1) {
            child = vfork();
            if (child == 0) {
                execv("/bin/true", arguments);
                _exit(1);
            }
        } else {
            std::printf("system %d\n", std::system("true")); // NOLINT(cert-env33-c)
        }
        if (child != 0) awaitChild(child);
        printFrame("parent", own, i);
    }
}

// The drawing thread may hold locks at the fork. The driver's locks would block more calls than these.
bool drawsOn = true;
void* drawInThread(void* plain) {
    auto& own = *static_cast<Plain*>(plain);
    glXMakeCurrent(own.display, own.window, own.context);
    for (int i = 0; __atomic_load_n(&drawsOn, __ATOMIC_RELAXED); ++i) drawFrames(own, i, 1);
    printFrame("thread", own, 40);
    glXMakeCurrent(own.display, None, nullptr);
    return nullptr;
}

void threads() {
    XInitThreads();
    const Plain own = openGlx();
    Plain other = makeGlx(own.display, own.context); // shares objects: every command takes the group's lock
    pthread_t thread{};
    pthread_create(&thread, nullptr, drawInThread, &other);
    for (int i = 0; i < 12; ++i) {
        drawFrames(own, i, 1);
        awaitChild(
            startChild([] { std::printf("error %x, current %d\n", glGetError(), glXGetCurrentContext() != nullptr); }));
    }
    __atomic_store_n(&drawsOn, false, __ATOMIC_RELAXED);
    pthread_join(thread, nullptr);
    printFrame("parent", own, 50);
}

// Draws in a child with the parent's connection. Run the program with LP_NUM_THREADS=0, with which llvmpipe draws in a
// child, too. After the child has used its X connection the parent must not, so the parent ends.
void inherited() {
    const Plain own = openGlx();
    printFrame("parent", own, 0);
    awaitChild(startChild([&] {
        printFrame("child", own, 1);
        printFrame("child's own", openGlx(), 2);
    }));
    std::fflush(stdout);
    _exit(0);
}

// Behaves like daemon(3): the parent ends, the child continues with a context of its own.
void daemonised() {
    const Plain own = openGlx();
    printFrame("parent", own, 0);
    std::fflush(stdout);
    int whole[2];
    if (pipe(whole) != 0) fail("no pipe");
    if (fork() == 0) {
        close(whole[1]);
        char byte = 0;
        if (read(whole[0], &byte, 1) != 0) fail("the parent wrote"); // end of file: the parent has ended
        setsid();
        const Plain childs = openGlx();
        drawFrames(childs, 1, 4);
        printFrame("daemon", childs, 5);
        _exit(0);
    }
    _exit(3);
}

} // namespace

int main(int, char** argv) {
    const char* way = argv[1] != nullptr ? argv[1] : "";
    const auto is = [&](const char* name) { return std::strcmp(way, name) == 0; };
    if (is("calls"))
        calls(false);
    else if (is("raw_calls"))
        calls(true);
    else if (is("together"))
        together(false, openGlx);
    else if (is("raw_together"))
        together(true, openGlx);
    else if (is("egl_together"))
        together(false, openEgl);
    else if (is("before"))
        before();
    else if (is("after"))
        after();
    else if (is("executed"))
        executed();
    else if (is("threads"))
        threads();
    else if (is("inherited"))
        inherited();
    else if (is("daemonised"))
        daemonised();
    else
        fail("no way of this name: %s", way);
    return 0;
}

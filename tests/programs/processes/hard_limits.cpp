// Programs that interrupt, close, replace, limit or prohibit resources that a library in them may need. A word selects
// the way.
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <pthread.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

#include "tests/programs/processes/plain_drawing.hpp"

using namespace programs;

namespace {

// ---- interruptions

volatile sig_atomic_t interruptions = 0;

void interruptAlways(bool restart) {
    struct sigaction action {};
    action.sa_handler = [](int) { interruptions = interruptions + 1; };
    action.sa_flags = restart ? SA_RESTART : 0;
    sigaction(SIGALRM, &action, nullptr);
    const itimerval timer{{0, 300}, {0, 300}};
    setitimer(ITIMER_REAL, &timer, nullptr);
}

void interrupted(bool restart) {
    Display* const display = XOpenDisplay(nullptr);
    if (display == nullptr) fail("no X display");
    XFree(plainVisual(display)); // loads the driver, which takes long under interruption
    interruptAlways(restart);
    const Plain own = makeGlx(display);
    glXMakeCurrent(own.display, own.window, own.context);
    drawFrames(own, 0, 20);
    printFrame("frame", own, 20);
    const itimerval none{};
    setitimer(ITIMER_REAL, &none, nullptr);
    std::printf("interrupted %s\n", interruptions > 5 ? "often" : "seldom");
}

// ---- descriptors

void closeAllBut(int except) {
    for (int fd = 3; fd < 1024; ++fd)
        if (fd != except) close(fd);
}

// Gives the descriptor numbers another meaning: a closed pipe, a pipe with bytes in it, files.
void reuseNumbers() {
    int hungUp[2], full[2];
    if (pipe(hungUp) != 0 || pipe(full) != 0 || write(full[1], "bytes", 5) != 5) fail("no pipes");
    close(hungUp[1]);
    for (int i = 0; i < 8; ++i) {
        if (dup(hungUp[0]) < 0 || dup(full[0]) < 0 || open("/dev/null", O_RDWR) < 0) fail("no descriptors");
    }
}

void closed(bool reuse) {
    const Plain own = openGlx();
    drawFrames(own, 0, 3);
    closeAllBut(ConnectionNumber(own.display));
    if (reuse) reuseNumbers();
    usleep(200'000); // time for another process to notice
    drawFrames(own, 3, 20);
    printFrame("frame", own, 23);
}

// Makes descriptor 2 a file of the program, to which no other code may write.
void daemonFiles() {
    char path[] = "/tmp/hard_limits.XXXXXX";
    const int file = mkstemp(path);
    unlink(path);
    const Plain own = openGlx();
    drawFrames(own, 0, 3);
    dup2(file, 2);
    // an unsupported call that causes a warning
    glSeparableFilter2D(GL_SEPARABLE_2D, GL_RGBA8, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, nullptr, nullptr);
    printFrame("frame", own, 3);
    struct stat facts {};
    fstat(file, &facts);
    std::printf("the file has %lld bytes\n", static_cast<long long>(facts.st_size));
}

// ---- limits

void limit(decltype(RLIMIT_NOFILE) which, rlim_t value) {
    const rlimit both{value, value};
    if (setrlimit(which, &both) != 0) fail("no such limit");
}

void limitedFirst() {
    const Plain own = makeGlx();
    limit(RLIMIT_FSIZE, 0);
    limit(RLIMIT_MEMLOCK, 0);
    limit(RLIMIT_CORE, 0);
    glXMakeCurrent(own.display, own.window, own.context);
    drawFrames(own, 0, 5);
    printFrame("frame", own, 5);
}

void limitedLater() {
    const Plain own = openGlx();
    drawFrames(own, 0, 3);
    limit(RLIMIT_NOFILE, 3);
    limit(RLIMIT_FSIZE, 0);
    limit(RLIMIT_MEMLOCK, 0);
    drawFrames(own, 3, 5);
    printFrame("frame", own, 8);
}

// ---- sandboxes

void sandbox(unsigned action) {
#define MURAL_REFUSE(number) BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, number, 0, 1), BPF_STMT(BPF_RET | BPF_K, action)
    sock_filter filter[] = {BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
                            MURAL_REFUSE(SYS_membarrier),
                            MURAL_REFUSE(SYS_process_vm_readv),
                            MURAL_REFUSE(SYS_userfaultfd),
                            MURAL_REFUSE(SYS_memfd_create),
                            MURAL_REFUSE(SYS_socket),
                            MURAL_REFUSE(SYS_connect),
                            MURAL_REFUSE(SYS_ptrace),
                            MURAL_REFUSE(SYS_execve),
                            MURAL_REFUSE(SYS_kcmp),
                            MURAL_REFUSE(SYS_pidfd_open),
                            MURAL_REFUSE(SYS_kill),
                            MURAL_REFUSE(SYS_flock),
                            MURAL_REFUSE(SYS_pipe2),
                            MURAL_REFUSE(SYS_mincore),
                            BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW)};
#undef MURAL_REFUSE
    const sock_fprog program{sizeof filter / sizeof *filter, filter};
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) != 0)
        fail("this kernel has no seccomp: %s", strerror(errno));
}

void* drawShared(void* plain) {
    auto& own = *static_cast<Plain*>(plain);
    glXMakeCurrent(own.display, own.window, own.context);
    drawFrames(own, 0, 10);
    printFrame("second", own, 10);
    glXMakeCurrent(own.display, None, nullptr);
    return nullptr;
}

// Sets a uniform array with a count above its length. The memory ends at the end of mapped memory.
void longUniforms() {
    const char* text = "uniform vec4 u[300]; void main() { gl_FragColor = u[int(mod(gl_FragCoord.x, 300.0))]; }";
    const GLuint program = glCreateProgram(), shader = glCreateShader(GL_FRAGMENT_SHADER);
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    glAttachShader(program, shader);
    glLinkProgram(program);
    glUseProgram(program);
    std::vector<float> values(4096 * 4);
    for (size_t i = 0; i < values.size(); ++i) values[i] = float(i % 101) / 101.0F;
    glUniform4fv(glGetUniformLocation(program, "u"), 300, values.data());
}

void lastingMapping() {
    constexpr GLsizeiptr kBytes = 1 << 20;
    constexpr GLbitfield kAccess = GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferStorage(GL_ARRAY_BUFFER, kBytes, nullptr, kAccess);
    auto* const corners = static_cast<float*>(glMapBufferRange(GL_ARRAY_BUFFER, 0, kBytes, kAccess));
    for (int i = 0; i < 600; ++i) corners[i] = float((i * 37) % 97) / 60.0F - 0.8F;
    glEnableClientState(GL_VERTEX_ARRAY);
    glVertexPointer(2, GL_FLOAT, 0, nullptr);
    glDrawArrays(GL_TRIANGLES, 0, 300);
}

void sandboxed(unsigned action) {
    XInitThreads();
    const Plain own = openGlx();
    Plain second = makeGlx(own.display, own.context);
    drawFrames(own, 0, 3);
    sandbox(action);
    drawFrames(own, 3, 3);
    pthread_t thread{};
    pthread_create(&thread, nullptr, drawShared, &second);
    drawFrames(own, 6, 10);
    pthread_join(thread, nullptr);
    drawPlain(1);
    longUniforms();
    drawPlain(16);
    lastingMapping();
    std::printf("uniforms and a mapping: %016llx error %x\n", static_cast<unsigned long long>(readPlain()),
                glGetError());
    own.show();
    glUseProgram(0);
    printFrame("frame", own, 17);
}

} // namespace

int main(int, char** argv) {
    const char* way = argv[1] != nullptr ? argv[1] : "";
    const auto is = [&](const char* name) { return std::strcmp(way, name) == 0; };
    if (is("interrupted"))
        interrupted(false);
    else if (is("interrupted_restart"))
        interrupted(true);
    else if (is("closed"))
        closed(false);
    else if (is("replaced"))
        closed(true);
    else if (is("daemon_files"))
        daemonFiles();
    else if (is("limited_first"))
        limitedFirst();
    else if (is("limited_later"))
        limitedLater();
    else if (is("sandbox_refuses"))
        sandboxed(SECCOMP_RET_ERRNO | EPERM);
    else if (is("sandbox_kills"))
        sandboxed(SECCOMP_RET_KILL_PROCESS);
    else
        fail("no way of this name: %s", way);
    return 0;
}

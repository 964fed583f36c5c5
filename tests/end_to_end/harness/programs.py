"""The test programs: names, groups, special cases, and functions that run one and keep its frames."""

import os
import select
import shlex
import signal
import subprocess

# Groups of programs. Every program belongs to exactly one; CTest runs one group per test.
GROUPS = {
    "vertices": ["immediate", "generic_attributes", "display_lists", "client_arrays", "draw_calls",
                 "core_arrays", "buffers", "persistent_mapping", "persistent_frames", "pinned_memory",
                 "evaluators", "same_scene", "late_uploads", "equal_state"],
    "pixels": ["textures_classic", "textures_modern", "framebuffers", "framebuffers_layered", "core_depth",
               "pixels_draw", "copied_samples", "copied_scene", "pixels_read", "texture_reads", "sized_reads", "compressed_reads", "reads_later", "reads_deferred", "reads_threads",
               "front_buffer", "front_and_back", "single_buffered", "frames_kept", "clears_in_turns", "load_step", "uneven_cost", "uneven_draws",
               "accum_buffer"],
    "state": ["raster_state", "blend_modes", "blended_rectangles", "multisampled_lines", "stippled_strips", "clipping", "fixed_lighting", "feedback_select",
              "attribute_stacks", "list_materials", "range_ties", "shared_draws", "arb_programs", "odd_calls", "list_questions", "refused_calls", "refused_core"],
    "shaders": ["glsl_legacy", "glsl_uniforms", "glsl_blocks", "glsl_stages", "spirv_shaders", "compute_images",
                "fragment_counters", "fragment_sums", "frag_coord", "fragment_places", "many_triangles", "no_depth", "queries", "queries_later",
                "direct_state_access", "program_binaries", "shader_includes",
                "draw_errors_compat", "draw_errors_core", "draw_errors_es3"],
    "culling": ["cut_lists", "cut_modes", "cut_streams", "cut_programs", "cut_scenes"],
    # Programs whose extensions few drivers have: elsewhere they report it and are skipped.
    "bindless": ["bindless_textures", "sparse_textures", "sparse_buffers"],
    # Run by no test: the only driver here with bindless images sometimes crashes in it (docs/measurements/exactness.md).
    "bindless_images": ["bindless_images"],
    "windows": ["es1_scene", "es1_draw_texture", "es2_scene", "es3_scene", "es_pipelines", "es_feedback_limit", "egl_desktop",
                "egl_offscreen", "egl_buffer_names", "egl_blended_rectangles", "egl_images", "egl_pixmaps",
                "egl_pbuffer_textures", "egl_bound_pbuffers", "egl_sync_order", "draw_read_mix", "fence_order", "flush_control", "surfaceless_sharing",
                "texture_from_pixmap", "debug_messages",
                "several_windows", "shared_contexts", "sharing_order", "thread_keys", "threads_windows",
                "loader_thread", "context_migration", "glx_pbuffers", "x_fonts", "x_pixmaps", "resize",
                "resize_moments", "resize_threads", "churn_threads", "window_churn", "window_switch", "windows_end", "drawable_lives", "object_churn", "large_objects"],
    "processes": ["route_dlsym", "route_deepbind", "route_glx_proc", "route_split_libraries",
                  "route_egl_proc", "route_plugin", "exit_dirty", "exit_quick", "exit_three",
                  "exit_abort", "exit_segv", "exit_term", "fork_child", "fork_exec"],
}

# Exit status of a program whose driver lacks its extension (tests/programs/support/needs.hpp).
SKIPPED = 77

# Exit status of programs that do not end with 0, in the form of subprocess.
STATUS = {"exit_three": 3, "exit_abort": -signal.SIGABRT, "exit_segv": -signal.SIGSEGV,
          "exit_term": -signal.SIGTERM}

# Programs that show frames with glFlush instead of a swap.
FLUSHING = {"single_buffered"}


def all_names():
    return [name for names in GROUPS.values() for name in names]


def choose(text):
    """Returns the names of a list of programs and groups, separated by commas; None: all."""
    if not text:
        return all_names()
    chosen = []
    for word in text.split(","):
        found = GROUPS.get(word, [word] if word in all_names() else None)
        if found is None:
            raise SystemExit("unknown program \"%s\"; --list shows all" % word)
        chosen += found
    return chosen


def clean_environment(display):
    """Returns only the variables that a program needs, so that results do not depend on the caller's settings."""
    keep = ("PATH", "HOME", "TMPDIR", "XDG_RUNTIME_DIR", "LANG", "LC_ALL", "MURAL_PLANT",
            "MURAL_LOG", "ASAN_OPTIONS", "UBSAN_OPTIONS", "LD_LIBRARY_PATH", "LIBGL_ALWAYS_SOFTWARE",
            "EGL_PLATFORM", "LP_NUM_THREADS", "CLEARS_FRONT", "GLIBC_TUNABLES", "MESA_SHADER_CACHE_DIR",
            # selection of the driver: a Mesa other than the system's
            "GALLIUM_DRIVER", "MESA_LOADER_DRIVER_OVERRIDE", "LIBGL_DRIVERS_PATH", "GBM_BACKENDS_PATH",
            "VK_ICD_FILENAMES", "VK_DRIVER_FILES", "__EGL_VENDOR_LIBRARY_DIRS")
    environment = {key: os.environ[key] for key in keep if key in os.environ}
    environment["DISPLAY"] = display
    return environment


class Run:
    """The results of one run of a program."""

    def __init__(self, status, output, folder):
        self.status = status  # None: it did not end in time
        self.output = output
        self.folder = folder
        self.captured = None  # frames drawn by the nodes; None: unknown

    def frames(self):
        """Returns {"w0/f0003.ppm": path} of all pictures."""
        found = {}
        for drawable in sorted(os.listdir(self.folder)):
            inside = os.path.join(self.folder, drawable)
            if os.path.isdir(inside):
                for name in sorted(os.listdir(inside)):
                    found[drawable + "/" + name] = os.path.join(inside, name)
        return found


def stop_group(process):
    """Ends all processes that the run has left in its session."""
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass


def ended_within(process, seconds):
    """Returns the status, or None after the timeout. Popen.wait with a timeout polls only every 50 ms, a third of many
    runs' duration."""
    pidfd = os.pidfd_open(process.pid)
    try:
        watch = select.poll()
        watch.register(pidfd, select.POLLIN)
        return process.wait() if watch.poll(seconds * 1000) else None
    finally:
        os.close(pidfd)


def command_of(build, name, folder, size, frames, library="grab.so", arguments=()):
    """Returns the shell settings that keep the program's frames, and the words of its command."""
    settings = "GRAB_OUT=%s " % shlex.quote(folder) + ("GRAB_FLUSH=1 " if name in FLUSHING else "")
    # The test's library comes before any library that the launcher preloads.
    settings += 'LD_PRELOAD="%s${LD_PRELOAD:+ $LD_PRELOAD}"' % os.path.join(build, "tests", "end_to_end", library)
    return settings, [os.path.join(build, "tests", "programs", name), "--size", size, "--frames", str(frames)] + list(arguments)


def run_program(build, name, folder, display, size, frames, launcher=(), seconds=120,
                more_environment=None, library="grab.so", arguments=()):
    """Runs a program, natively or with `launcher`, with the grabbing library preloaded."""
    os.makedirs(folder)
    environment = clean_environment(display)
    environment.update(more_environment or {})
    settings, words = command_of(build, name, folder, size, frames, library, arguments)
    command = list(launcher) + ["sh", "-c", settings + ' exec "$@"', "sh"] + words
    log_path = folder + ".log"
    with open(log_path, "wb") as log:
        process = subprocess.Popen(command, env=environment, stdin=subprocess.DEVNULL, stdout=log,
                                   stderr=subprocess.STDOUT, start_new_session=True)
        status = ended_within(process, seconds)
        stop_group(process)
        process.wait()
    with open(log_path, encoding="utf-8", errors="replace") as log:
        return Run(status, log.read().strip(), folder)


def same_status(native, through):
    """Compares statuses. A launcher reports death by a signal as 128 + its number, as shells do."""
    if native is not None and native < 0:
        return through in (native, 128 - native)
    return native == through

# Programs whose pictures still differ from the native ones, with the reason (docs/measurements/exactness.md has the proofs).
KNOWN_DIFFERENCES = {
    "egl_pbuffer_textures": "Mesa's software driver leaves textures of pbuffers empty; the nodes show the pictures",
}

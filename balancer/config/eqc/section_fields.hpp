// The sections of a configuration file and their fields, defined once for reader and writer. A walker has
//   value(word, optional)      a field with a value; the last repetition counts
//   attribute(word, a, kind)   a field with an attribute value
//   repeated(word, values)     a field that may occur several times
//   section(word, optional)    a section; the last repetition counts
//   sections(word, values)     sections that may occur several times
//   merged(word, section)      a section whose repetitions add to the first
//   surface(optional)          wall or projection
//   equalizers(values)         any of the equalizers
// Words that begin with mural_ are extensions of Equalizer's format.
#pragma once

#include <concepts>

#include "balancer/config/eqc/words.hpp"

namespace mural::config {

template <class T, class Section> concept Is = std::same_as<std::remove_const_t<T>, Section>;

void fields(auto& walk, Is<Connection> auto& c) {
    walk.value("type", c.type);
    walk.value("hostname", c.hostname);
    walk.value("interface", c.interface_);
    walk.value("port", c.port);
    walk.value("bandwidth", c.bandwidth);
    walk.value("filename", c.filename);
}

void fields(auto& walk, Is<ChannelAttributes> auto& a) {
    walk.attribute("hint_statistics", a.hintStatistics, AttributeKind::Statistics);
    walk.attribute("hint_sendtoken", a.hintSendToken, AttributeKind::Switch);
    walk.value("dump_image", a.dumpImage);
}

void fields(auto& walk, Is<Channel> auto& c) {
    walk.value("name", c.name);
    walk.value("viewport", c.viewport);
    walk.merged("attributes", c.attributes);
}

void fields(auto& walk, Is<WindowAttributes> auto& a) {
    walk.attribute("hint_core_profile", a.hintCoreProfile, AttributeKind::Switch);
    walk.attribute("hint_opengl_major", a.hintOpenglMajor, AttributeKind::Number);
    walk.attribute("hint_opengl_minor", a.hintOpenglMinor, AttributeKind::Number);
    walk.attribute("hint_stereo", a.hintStereo, AttributeKind::Switch);
    walk.attribute("hint_doublebuffer", a.hintDoublebuffer, AttributeKind::Switch);
    walk.attribute("hint_fullscreen", a.hintFullscreen, AttributeKind::Switch);
    walk.attribute("hint_decoration", a.hintDecoration, AttributeKind::Switch);
    walk.attribute("hint_swapsync", a.hintSwapsync, AttributeKind::Switch);
    walk.attribute("hint_drawable", a.hintDrawable, AttributeKind::Switch);
    walk.attribute("hint_statistics", a.hintStatistics, AttributeKind::Statistics);
    walk.attribute("hint_screensaver", a.hintScreensaver, AttributeKind::Switch);
    walk.attribute("hint_grab_pointer", a.hintGrabPointer, AttributeKind::Switch);
    walk.attribute("planes_color", a.planesColor, AttributeKind::Number);
    walk.attribute("planes_alpha", a.planesAlpha, AttributeKind::Number);
    walk.attribute("planes_depth", a.planesDepth, AttributeKind::Number);
    walk.attribute("planes_stencil", a.planesStencil, AttributeKind::Number);
    walk.attribute("planes_accum", a.planesAccum, AttributeKind::Number);
    walk.attribute("planes_accum_alpha", a.planesAccumAlpha, AttributeKind::Number);
    walk.attribute("planes_samples", a.planesSamples, AttributeKind::Number);
}

void fields(auto& walk, Is<Window> auto& w) {
    walk.value("name", w.name);
    walk.value("viewport", w.viewport);
    walk.merged("attributes", w.attributes);
    walk.sections("channel", w.channels);
}

void fields(auto& walk, Is<PipeAttributes> auto& a) {
    walk.attribute("hint_thread", a.hintThread, AttributeKind::Switch);
    walk.attribute("hint_affinity", a.hintAffinity, AttributeKind::Affinity);
}

void fields(auto& walk, Is<Pipe> auto& p) {
    walk.value("name", p.name);
    walk.value("port", p.port);
    walk.value("device", p.device);
    walk.value("viewport", p.viewport);
    walk.merged("attributes", p.attributes);
    walk.sections("window", p.windows);
}

void fields(auto& walk, Is<NodeAttributes> auto& a) {
    walk.value("launch_command", a.launchCommand);
    walk.value("launch_command_quote", a.launchCommandQuote);
    walk.attribute("launch_timeout", a.launchTimeout, AttributeKind::Number);
    walk.attribute("thread_model", a.threadModel, AttributeKind::Switch);
    walk.attribute("hint_affinity", a.hintAffinity, AttributeKind::Affinity);
    walk.attribute("hint_statistics", a.hintStatistics, AttributeKind::Statistics);
}

void fields(auto& walk, Is<Node> auto& n) {
    walk.value("name", n.name);
    walk.value("host", n.host);
    walk.sections("connection", n.connections);
    walk.merged("attributes", n.attributes);
    walk.sections("pipe", n.pipes);
}

void fields(auto& walk, Is<Wall> auto& w) {
    walk.value("bottom_left", w.bottomLeft);
    walk.value("bottom_right", w.bottomRight);
    walk.value("top_left", w.topLeft);
    walk.value("type", w.type);
}

void fields(auto& walk, Is<Projection> auto& p) {
    walk.value("origin", p.origin);
    walk.value("distance", p.distance);
    walk.value("fov", p.fov);
    walk.value("hpr", p.hpr);
}

void fields(auto& walk, Is<Observer> auto& o) {
    walk.value("name", o.name);
    walk.value("eye_base", o.eyeBase); // precedes the eyes: it places all of them
    walk.value("eye_left", o.eyeLeft);
    walk.value("eye_cyclop", o.eyeCyclop);
    walk.value("eye_right", o.eyeRight);
    walk.value("focus_distance", o.focusDistance);
    walk.value("focus_mode", o.focusMode);
    walk.attribute("opencv_camera", o.opencvCamera, AttributeKind::Switch);
    walk.value("vrpn_tracker", o.vrpnTracker);
}

// Views have this single attribute.
template <class V> struct ViewAttributes { V& view; };
template <class V> void fields(auto& walk, ViewAttributes<V>& a) { walk.value("deflect_host", a.view.deflectHost); }

template <Is<View> V> void fields(auto& walk, V& v) {
    walk.value("name", v.name);
    walk.value("mode", v.mode);
    walk.value("viewport", v.viewport);
    walk.surface(v.surface);
    walk.value("observer", v.observer);
    ViewAttributes<V> attributes{v};
    walk.merged("attributes", attributes);
}

void fields(auto& walk, Is<Layout> auto& l) {
    walk.value("name", l.name);
    walk.sections("view", l.views);
}

void fields(auto& walk, Is<SwapBarrier> auto& b) {
    walk.value("name", b.name);
    walk.attribute("NV_group", b.nvGroup, AttributeKind::Number);
    walk.attribute("NV_barrier", b.nvBarrier, AttributeKind::Number);
}

void fields(auto& walk, Is<Segment> auto& s) {
    walk.value("name", s.name);
    walk.value("channel", s.channel);
    walk.repeated("mural_copy_to", s.copies);
    walk.value("eye", s.eyes);
    walk.value("viewport", s.viewport);
    walk.value("mural_bezel_mm", s.bezel);
    walk.surface(s.surface);
    walk.section("swapbarrier", s.swapBarrier);
}

void fields(auto& walk, Is<Canvas> auto& c) {
    walk.value("name", c.name);
    walk.repeated("layout", c.layouts);
    walk.surface(c.surface);
    walk.value("mural_bezel_mm", c.bezel);
    walk.section("swapbarrier", c.swapBarrier);
    walk.sections("segment", c.segments);
}

void fields(auto& walk, Is<Frame> auto& f) {
    walk.value("name", f.name);
    walk.value("type", f.type);
    walk.value("viewport", f.viewport);
    walk.value("buffer", f.buffers);
    walk.value("zoom", f.zoom);
    walk.value("mural_codec", f.codec);
    walk.attribute("mural_exact", f.exact, AttributeKind::Switch);
}

void fields(auto& walk, Is<TileQueue> auto& q) {
    walk.value("name", q.name);
    walk.value("size", q.size);
}

void fields(auto& walk, Is<LoadEqualizer> auto& e) {
    walk.value("mode", e.mode);
    walk.value("damping", e.damping);
    walk.value("assemble_only_limit", e.assembleOnlyLimit);
    walk.value("boundary", e.boundary);
    walk.value("resistance", e.resistance);
}

void fields(auto& walk, Is<TreeEqualizer> auto& e) {
    walk.value("mode", e.mode);
    walk.value("damping", e.damping);
    walk.value("boundary", e.boundary);
    walk.value("resistance", e.resistance);
}

void fields(auto& walk, Is<DfrEqualizer> auto& e) {
    walk.value("framerate", e.frameRate);
    walk.value("damping", e.damping);
    walk.value("mural_minimum", e.minimum);
}

void fields(auto&, Is<FramerateEqualizer> auto&) {}
void fields(auto&, Is<MonitorEqualizer> auto&) {}
void fields(auto&, Is<ViewEqualizer> auto&) {}

void fields(auto& walk, Is<TileEqualizer> auto& e) {
    walk.value("name", e.name);
    walk.value("size", e.size);
}

// Returns the keyword of an equalizer's section.
inline std::string_view sectionName(const LoadEqualizer&) { return "load_equalizer"; }
inline std::string_view sectionName(const TreeEqualizer&) { return "tree_equalizer"; }
inline std::string_view sectionName(const DfrEqualizer&) { return "DFR_equalizer"; }
inline std::string_view sectionName(const FramerateEqualizer&) { return "framerate_equalizer"; }
inline std::string_view sectionName(const MonitorEqualizer&) { return "monitor_equalizer"; }
inline std::string_view sectionName(const ViewEqualizer&) { return "view_equalizer"; }
inline std::string_view sectionName(const TileEqualizer&) { return "tile_equalizer"; }

void fields(auto& walk, Is<CompoundAttributes> auto& a) {
    walk.attribute("stereo_mode", a.stereoMode, AttributeKind::Switch);
    walk.value("stereo_anaglyph_left_mask", a.anaglyphLeftMask);
    walk.value("stereo_anaglyph_right_mask", a.anaglyphRightMask);
}

void fields(auto& walk, Is<Compound> auto& c) {
    walk.value("name", c.name);
    walk.value("channel", c.channel);
    walk.value("task", c.tasks);
    walk.value("eye", c.eyes);
    walk.value("buffer", c.buffers);
    walk.value("viewport", c.viewport);
    walk.value("range", c.range);
    walk.value("period", c.period);
    walk.value("phase", c.phase);
    walk.value("zoom", c.zoom);
    walk.value("pixel", c.pixel);
    walk.value("subpixel", c.subPixel);
    walk.value("mural_composition", c.composition);
    walk.surface(c.surface);
    walk.merged("attributes", c.attributes);
    walk.equalizers(c.equalizers);
    walk.section("swapbarrier", c.swapBarrier);
    walk.sections("outputtiles", c.outputTiles);
    walk.sections("inputtiles", c.inputTiles);
    walk.sections("compound", c.children);
    walk.sections("outputframe", c.outputFrames);
    walk.sections("inputframe", c.inputFrames);
}

void fields(auto& walk, Is<ConfigAttributes> auto& a) {
    walk.value("eye_base", a.eyeBase);
    walk.attribute("robustness", a.robustness, AttributeKind::Switch);
}

void fields(auto& walk, Is<Config> auto& c) {
    walk.value("name", c.name);
    walk.value("latency", c.latency);
    walk.merged("attributes", c.attributes);
    walk.merged("appNode", c.appNode);
    walk.sections("node", c.nodes);
    walk.sections("observer", c.observers);
    walk.sections("layout", c.layouts);
    walk.sections("canvas", c.canvases);
    walk.sections("compound", c.compounds);
}

} // namespace mural::config

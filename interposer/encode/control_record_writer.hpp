// Control records: all records that are not GL commands. Layouts: wire::Op.
#pragma once

#include "interposer/encode/encode_support.hpp"
#include "streamcodec/wire/client_arrays.hpp"
#include "streamcodec/wire/control_records.hpp"

namespace mural::records {

void blobBegin(ThreadState& t, uint64_t sizeBytes);
bool blobData(ThreadState& t, const void* data, uint32_t sizeBytes);

struct ContextInfo {
    uint32_t context, shareContext, api, major, minor, profileMask, flags;
    wire::WindowConfig config;
};
void createContext(ThreadState& t, const ContextInfo& info);
void destroyContext(ThreadState& t, uint32_t context);
void makeCurrent(ThreadState& t, uint32_t context, uint32_t draw, uint32_t read);
void window(ThreadState& t, uint32_t window, const wire::WindowConfig& config);
void destroyWindow(ThreadState& t, uint32_t window);
void swap(ThreadState& t, uint32_t window, uint32_t frame);
void frontPicture(ThreadState& t, uint32_t window, uint32_t frame);
void requestPixels(ThreadState& t, uint32_t request, GLint x, GLint y, GLsizei w, GLsizei h, GLenum format, GLenum type,
                   uint32_t groupBytes);
void requestTexImage(ThreadState& t, uint32_t request, uint32_t byName, GLuint targetOrTexture, GLint level,
                     GLenum format, GLenum type, uint64_t sizeBytes);
void requestQuery(ThreadState& t, uint32_t request, GLuint query, GLenum pname);
void requestFinish(ThreadState& t, uint32_t request);
void beginConditional(ThreadState& t, bool draws);
void drawAll(ThreadState& t);
bool errorReported(ThreadState& t); // false: no session
void requestProgram(ThreadState& t, uint32_t request, GLuint program);
void programRecipe(ThreadState& t, GLuint program, const DataArg& recipe);
void queryKnown(ThreadState& t, GLuint query, bool passed);
void requestBuffer(ThreadState& t, uint32_t request, GLuint buffer, uint64_t offset, uint64_t sizeBytes);
void fillWindow(ThreadState& t, GLint x, GLint y, GLsizei w, GLsizei h, uint32_t planes, const DataArg& pixels);
void bufferBytes(ThreadState& t, GLuint buffer, uint64_t offset, const DataArg& bytes);
void programLayout(ThreadState& t, GLuint program, const DataArg& layout);
struct ImageInfo {
    uint64_t image;
    uint32_t context, target, name;
    int32_t level, layer;
};
void createImage(ThreadState& t, const ImageInfo& info);
void destroyImage(ThreadState& t, uint64_t image);
void clientArrays(ThreadState& t, const client_arrays::ArrayRecord* arrays, uint32_t arrayCount, const DataArg* spans,
                  uint32_t spanCount);

} // namespace mural::records

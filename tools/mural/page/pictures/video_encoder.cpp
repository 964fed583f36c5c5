#include "tools/mural/page/pictures/video_encoder.hpp"

#include <array>
#include <vector>
#include <turbojpeg.h>
#include <wels/codec_api.h>

namespace mural::page {

namespace {

constexpr int kQuantizer = 24;           // constant: text stays readable, and a resting picture costs few bytes
constexpr float kNominalRate = 60;       // only rate control would use it
constexpr int kNominalBits = 50'000'000; // as above
constexpr size_t kPlanes = 3;

struct EndEncoder {
    void operator()(ISVCEncoder* encoder) const {
        encoder->Uninitialize();
        WelsDestroySVCEncoder(encoder);
    }
};
struct EndConverter {
    void operator()(void* handle) const { tjDestroy(handle); }
};

// JPEG's colours: BT.601 with the full range. libjpeg-turbo converts to them with vector instructions.
void setColours(SSpatialLayerConfig& layer) {
    layer.bVideoSignalTypePresent = true;
    layer.uiVideoFormat = VF_UNDEF;
    layer.bFullRange = true;
    layer.bColorDescriptionPresent = true;
    layer.uiColorPrimaries = CP_BT709;
    layer.uiTransferCharacteristics = TRC_BT709;
    layer.uiColorMatrix = CM_SMPTE170M;
}

std::unique_ptr<ISVCEncoder, EndEncoder> openEncoder(int width, int height) {
    ISVCEncoder* made = nullptr;
    if (WelsCreateSVCEncoder(&made) != 0 || made == nullptr) return nullptr;
    std::unique_ptr<ISVCEncoder, EndEncoder> encoder(made);
    SEncParamExt terms;
    encoder->GetDefaultParams(&terms);
    terms.iUsageType = CAMERA_VIDEO_REAL_TIME;
    terms.iPicWidth = width;
    terms.iPicHeight = height;
    terms.fMaxFrameRate = kNominalRate;
    terms.iTargetBitrate = kNominalBits;
    terms.iRCMode = RC_OFF_MODE;
    terms.bEnableFrameSkip = false;
    terms.uiIntraPeriod = 0;
    terms.eSpsPpsIdStrategy = CONSTANT_ID;
    terms.iEntropyCodingModeFlag = 0;
    terms.iMultipleThreadIdc = 1;
    terms.iNumRefFrame = 1;
    terms.iComplexityMode = LOW_COMPLEXITY;
    terms.bEnableDenoise = false;
    terms.bEnableBackgroundDetection = true; // resting parts cost little time
    terms.bEnableAdaptiveQuant = false;
    terms.bEnableSceneChangeDetect = false;
    terms.iSpatialLayerNum = terms.iTemporalLayerNum = 1;
    SSpatialLayerConfig& layer = terms.sSpatialLayers[0];
    layer.iVideoWidth = width;
    layer.iVideoHeight = height;
    layer.fFrameRate = kNominalRate;
    layer.iSpatialBitrate = kNominalBits;
    layer.uiProfileIdc = PRO_BASELINE;
    layer.iDLayerQp = kQuantizer;
    layer.sSliceArgument.uiSliceMode = SM_SINGLE_SLICE;
    setColours(layer);
    if (encoder->InitializeExt(&terms) != 0) return nullptr;
    int quiet = WELS_LOG_QUIET;
    encoder->SetOption(ENCODER_OPTION_TRACE_LEVEL, &quiet);
    return encoder;
}

} // namespace

struct VideoEncoder::Impl {
    std::unique_ptr<void, EndConverter> converter{tjInitCompress()};
    std::unique_ptr<ISVCEncoder, EndEncoder> encoder;
    int width = 0, height = 0;
    std::array<std::vector<unsigned char>, kPlanes> planes; // Y, Cb, Cr
};

VideoEncoder::VideoEncoder() : impl_(std::make_unique<Impl>()) {}

VideoEncoder::~VideoEncoder() = default;

Result<VideoUnit> VideoEncoder::encode(const Picture& picture, bool isKeyFrame) {
    const int width = picture.width & ~1, height = picture.height & ~1;
    if (!canEncode(width, height)) return Error{"OpenH264 has no pictures of this size"};
    Impl& own = *impl_;
    if (!own.encoder || width != own.width || height != own.height) {
        own.encoder = openEncoder(width, height);
        if (!own.encoder) return Error{"OpenH264 cannot encode pictures here"};
        own.width = width;
        own.height = height;
        const auto pixels = static_cast<size_t>(width) * static_cast<size_t>(height);
        own.planes = {std::vector<unsigned char>(pixels), std::vector<unsigned char>(pixels / 4),
                      std::vector<unsigned char>(pixels / 4)};
        isKeyFrame = true;
    }
    std::array<unsigned char*, kPlanes> to{own.planes[0].data(), own.planes[1].data(), own.planes[2].data()};
    std::array<int, kPlanes> strides{width, width / 2, width / 2};
    // An odd height loses its lowest row, which is the first one.
    const auto* from = reinterpret_cast<const unsigned char*>(picture.row(picture.height - height));
    if (!own.converter ||
        tjEncodeYUVPlanes(own.converter.get(), from, width, static_cast<int>(picture.rowBytes()), height, TJPF_BGRX,
                          to.data(), strides.data(), TJSAMP_420, TJFLAG_BOTTOMUP) != 0)
        return Error{"libjpeg-turbo cannot convert the picture"};

    SSourcePicture source{};
    source.iPicWidth = width;
    source.iPicHeight = height;
    source.iColorFormat = videoFormatI420;
    for (size_t i = 0; i < kPlanes; ++i) {
        source.pData[i] = to[i];
        source.iStride[i] = strides[i];
    }
    if (isKeyFrame) own.encoder->ForceIntraFrame(true);
    SFrameBSInfo info{};
    if (own.encoder->EncodeFrame(&source, &info) != cmResultSuccess) return Error{"OpenH264 cannot encode a picture"};
    VideoUnit unit;
    unit.width = width;
    unit.height = height;
    unit.isKeyFrame = info.eFrameType == videoFrameTypeIDR;
    for (int i = 0; i < info.iLayerNum; ++i) {
        const SLayerBSInfo& layer = info.sLayerInfo[i];
        size_t bytes = 0;
        for (int nal = 0; nal < layer.iNalCount; ++nal) bytes += static_cast<size_t>(layer.pNalLengthInByte[nal]);
        unit.bytes.append(reinterpret_cast<const char*>(layer.pBsBuf), bytes);
    }
    return unit;
}

} // namespace mural::page

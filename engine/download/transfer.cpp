#include "download/transfer.h"

#include "core/interrupt.h"
#include "core/load_error.h"
#include "core/translate.h"
#include "core/version.h"
#include "download/address.h"
#include "download/curl_library.h"

#include <fmt/format.h>
#include <chrono>
#include <new>
#include <optional>
#include <string_view>
#include <utility>

namespace palpa {
namespace {

constexpr std::string_view by_hand = "or save the file with a browser and open it";

}  // namespace

#ifdef PALPA_CURL

namespace {

using Clock = std::chrono::steady_clock;

// The end of a transfer.
struct Answer {
    long status = 0;  // of HTTP; 0: none came
    std::string redirect{};
    std::string body{};
    CURLcode result = CURLE_OK;
    bool is_stalled = false, is_too_large = false, lacks_memory = false;
};

// One request, without following redirects.
class Request {
public:
    Request(const Curl& curl, const std::string& address, const TransferLimits& limits)
        : curl_(curl), limits_(limits), easy_(curl.easy_init()), multi_(curl.multi_init()) {
        if (!easy_ || !multi_ || !set_options(address)) {
            close();
            throw LoadError({address}, "cannot be downloaded: libcurl refuses its settings");
        }
        curl_.multi_add_handle(multi_, easy_);
    }
    Request(const Request&) = delete;
    Request& operator=(const Request&) = delete;
    ~Request() {
        curl_.multi_remove_handle(multi_, easy_);
        close();
    }

    Answer run(const StageFunction& on_stage);

private:
    template <class Value>
    bool set(CURLoption option, Value value) {
        return curl_.easy_setopt(easy_, option, value) == CURLE_OK;
    }
    bool set_options(const std::string& address);
    void close() {
        if (easy_) curl_.easy_cleanup(easy_);
        if (multi_) (void)curl_.multi_cleanup(multi_);
    }
    static std::size_t take(char* data, std::size_t size, std::size_t count, void* request);
    bool add(std::string_view part);
    long find_status() const {
        long status = 0;
        (void)curl_.easy_getinfo(easy_, CURLINFO_RESPONSE_CODE, &status);
        return status;
    }
    bool is_stalled(Clock::time_point now);
    void tell_progress(const StageFunction& on_stage) const;

    const Curl& curl_;
    const TransferLimits& limits_;
    CURL* easy_;
    CURLM* multi_;
    Answer answer_;
    std::size_t received_ = 0;
    // The start of the time in which enough bytes must arrive, and the bytes before.
    Clock::time_point since_ = Clock::now();
    std::size_t before_ = 0;
};

bool Request::set_options(const std::string& address) {
    const bool is_local = is_local_address(address);
    // The essential ones, which every version has.
    const bool is_set =
        set(CURLOPT_URL, address.c_str()) &&
        set(CURLOPT_PROTOCOLS, static_cast<long>(is_local ? CURLPROTO_HTTP : CURLPROTO_HTTPS)) &&
        set(CURLOPT_FOLLOWLOCATION, 0L) && set(CURLOPT_SSL_VERIFYPEER, 1L) &&
        set(CURLOPT_SSL_VERIFYHOST, 2L) && set(CURLOPT_NOSIGNAL, 1L) &&
        set(CURLOPT_MAXFILESIZE_LARGE, static_cast<curl_off_t>(limits_.most_bytes)) &&
        set(CURLOPT_WRITEFUNCTION, &Request::take) && set(CURLOPT_WRITEDATA, this) &&
        set(CURLOPT_USERAGENT, fmt::format("Palpa/{}", version_name).c_str());
    if (is_local && !set(CURLOPT_PROXY, "")) return false;
#if LIBCURL_VERSION_NUM >= 0x075700
    (void)set(CURLOPT_QUICK_EXIT, 1L);  // or the end would wait for the look-up of a name
#endif
    return is_set;
}

std::size_t Request::take(char* data, std::size_t size, std::size_t count, void* request) {
    Request& self = *static_cast<Request*>(request);
    try {
        return self.add({data, size * count}) ? size * count : 0;
    } catch (const std::bad_alloc&) {
        self.answer_.lacks_memory = true;
        return 0;
    }
}

// Keeps the bytes of a success, skips those of other answers; false ends the transfer.
bool Request::add(std::string_view part) {
    constexpr std::size_t most_skipped = 1 << 20;
    constexpr long success = 200;
    received_ += part.size();
    if (find_status() != success) return received_ <= most_skipped;
    answer_.is_too_large = received_ > limits_.most_bytes;
    if (answer_.is_too_large) return false;
    answer_.body += part;
    return true;
}

bool Request::is_stalled(Clock::time_point now) {
    constexpr double least_per_s = 100;
    const std::chrono::duration<double> passed = now - since_;
    if (passed.count() < limits_.stall_s) return false;
    const auto got = static_cast<double>(received_ - std::exchange(before_, received_));
    since_ = now;
    return got < least_per_s * limits_.stall_s;
}

void Request::tell_progress(const StageFunction& on_stage) const {
    curl_off_t size = 0;
    (void)curl_.easy_getinfo(easy_, CURLINFO_CONTENT_LENGTH_DOWNLOAD_T, &size);
    std::optional<double> share;
    if (size > 0) share = static_cast<double>(answer_.body.size()) / static_cast<double>(size);
    tell(on_stage, for_translation("downloading"), share);
}

Answer Request::run(const StageFunction& on_stage) {
    constexpr int wait_ms = 50;
    for (int running = 1; running > 0;) {
        if (noted_interrupt() != 0) throw Interrupted{};
        tell_progress(on_stage);
        if (is_stalled(Clock::now())) {
            answer_.is_stalled = true;
            return std::move(answer_);
        }
        if (curl_.multi_perform(multi_, &running) != CURLM_OK) break;
        if (running > 0) (void)curl_.multi_poll(multi_, nullptr, 0, wait_ms, nullptr);
    }
    int left = 0;
    const CURLMsg* const message = curl_.multi_info_read(multi_, &left);
    answer_.result = message ? message->data.result : CURLE_FAILED_INIT;
    answer_.status = find_status();
    const char* redirect = nullptr;
    (void)curl_.easy_getinfo(easy_, CURLINFO_REDIRECT_URL, &redirect);
    if (redirect) answer_.redirect = redirect;
    return std::move(answer_);
}

// Throws LoadError unless the whole content came.
void check_answer(const Curl& curl, const Answer& answer, const std::string& address,
                  const TransferLimits& limits) {
    constexpr long success = 200, no_entry = 404, gone = 410;
    const auto fail = [&](const std::string& why) { throw LoadError({address}, why); };
    if (answer.is_stalled)
        fail(fmt::format("less than 100 bytes a second came for {:g} s; check the network, {}",
                         limits.stall_s, by_hand));
    if (answer.status == no_entry || answer.status == gone)
        fail(fmt::format("the server has no such file ({}); check the code", answer.status));
    if (answer.status != 0 && answer.status != success)
        fail(fmt::format("the server answered {}; try again later, {}", answer.status, by_hand));
    if (answer.is_too_large || answer.result == CURLE_FILESIZE_EXCEEDED)
        fail(
            fmt::format("is larger than {} MB, which is the limit", limits.most_bytes / 1'000'000));
    if (answer.lacks_memory) fail("does not fit into memory");
    switch (answer.result) {
        case CURLE_OK:
            return;
        case CURLE_PARTIAL_FILE:
        case CURLE_GOT_NOTHING:
        case CURLE_RECV_ERROR:
        case CURLE_HTTP2:
        case CURLE_HTTP2_STREAM:
            fail(fmt::format("was cut off after {} bytes; try again", answer.body.size()));
            break;
        case CURLE_COULDNT_RESOLVE_PROXY:
        case CURLE_COULDNT_RESOLVE_HOST:
        case CURLE_COULDNT_CONNECT:
            fail(fmt::format("cannot be reached ({}); check the network, {}",
                             curl.easy_strerror(answer.result), by_hand));
            break;
        case CURLE_PEER_FAILED_VERIFICATION:
        case CURLE_SSL_CACERT_BADFILE:
            fail(
                fmt::format("cannot be trusted ({}); check the clock and the system's certificates "
                            "(Debian: ca-certificates)",
                            curl.easy_strerror(answer.result)));
            break;
        default:
            fail(fmt::format("cannot be downloaded ({}); try again later, {}",
                             curl.easy_strerror(answer.result), by_hand));
    }
}

}  // namespace

std::string download(const std::string& address, const TransferLimits& limits,
                     const StageFunction& on_stage) {
    check_address(address, true);
    const Curl* const curl = curl_of_system();
    if (!curl)
        throw LoadError({address},
                        fmt::format("cannot be downloaded: libcurl is not installed (Debian: "
                                    "libcurl4); install it, {}",
                                    by_hand));
    std::string at = address;
    for (int redirects = 0; redirects <= limits.most_redirects; ++redirects) {
        Answer answer = Request(*curl, at, limits).run(on_stage);
        if (answer.redirect.empty()) {
            check_answer(*curl, answer, at, limits);
            return std::move(answer.body);
        }
        const bool is_allowed = answer.redirect.starts_with("https://") ||
                                (is_local_address(address) && is_local_address(answer.redirect));
        if (!is_allowed)
            throw LoadError({address}, fmt::format("leads to {}; expected an address with https://",
                                                   answer.redirect));
        at = std::move(answer.redirect);
    }
    throw LoadError({address}, fmt::format("leads on more than {} times; check the address",
                                           limits.most_redirects));
}

std::string describe_curl() {
    const Curl* const curl = curl_of_system();
    return curl ? curl->version_info(CURLVERSION_NOW)->version
                : "none: libcurl.so.4 is not installed; PDB codes are not downloaded";
}

#else

std::string download(const std::string& address, const TransferLimits& /*limits*/,
                     const StageFunction& /*on_stage*/) {
    check_address(address, true);
    throw LoadError({address},
                    fmt::format("cannot be downloaded: this Palpa was built without libcurl; "
                                "build it with the library, {}",
                                by_hand));
}

std::string describe_curl() { return "none: built without it; PDB codes are not downloaded"; }

#endif

}  // namespace palpa

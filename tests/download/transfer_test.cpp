#include "download/transfer.h"

#include "download/address.h"
#include "tests/support/load_error_of.h"

#include <catch2/catch.hpp>

using namespace palpa;
using Catch::Matchers::Contains;

TEST_CASE("only https, and http at this computer, is downloaded from", "[download][transfer]") {
    for (const char* const address :
         {"http://localhost", "http://localhost/", "http://localhost:80/a", "http://127.0.0.1:8/",
          "http://127.1.2.3/", "http://[::1]:8080/a"}) {
        INFO(address);
        CHECK(is_local_address(address));
        CHECK_NOTHROW(check_address(address, true));
        CHECK_THAT(test::load_error_of([&] { check_address(address, false); }),
                   Contains("expected an address with https://"));
    }
    CHECK_NOTHROW(check_address("https://example.org/", false));
    for (const char* const address :
         {"", "https://", "http://example.org/", "http://localhost.example.org/",
          "http://localhost@example.org/", "http://127.0.0.1@example.org/",
          "http://127.0.0.1.example.org/", "http://localhost:8@example.org/",
          "http://localhost\\@example.org/", "http://localhost?@example.org/", "http://127./../x@y",
          "file:///etc/passwd", "ftp://localhost/", "HTTP://example.org/", "localhost"}) {
        INFO(address);
        CHECK_THAT(test::load_error_of([&] { check_address(address, true); }),
                   Contains("expected an address with https://"));
    }
}

TEST_CASE("nothing is asked for at an address that is refused", "[download][transfer]") {
    CHECK_THAT(test::load_error_of([] { (void)download("http://example.org/1hsg.cif.gz"); }),
               Contains("http://example.org/1hsg.cif.gz: cannot be downloaded from"));
}

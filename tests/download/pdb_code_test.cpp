#include "download/pdb_code.h"

#include <catch2/catch.hpp>

using namespace palpa;

TEST_CASE("a code has a digit and three letters or digits, or the extended form",
          "[download][code]") {
    for (const char* const code : {"1hsg", "1HSG", "9z9z", "1914", "pdb_00001hsg", "PDB_1A2B3C4D"})
        CHECK(is_pdb_code(code));
    for (const char* const text :
         {"", "hsg1", "0hsg", "1hs", "1hsga", "1hs.", "1hs ", "water", "hiv", "pdb_1hsg",
          "pdb_00001hs", "pdb_00001hsgg", "pdb-00001hsg", "1hs\xc3\xa4", "../1", "1/hs"})
        CHECK_FALSE(is_pdb_code(text));
}

TEST_CASE("an extended code that stands for a short one is the short one", "[download][code]") {
    CHECK(plain_pdb_code("1HSG") == "1hsg");
    CHECK(plain_pdb_code("PDB_00001HSG") == "1hsg");
    CHECK(plain_pdb_code("pdb_0000ahsg") == "pdb_0000ahsg");
    CHECK(plain_pdb_code("pdb_10001hsg") == "pdb_10001hsg");
}

TEST_CASE("links to pages and files of the wwPDB's sites name their entry", "[download][code]") {
    for (const char* const link :
         {"1HSG", "  1hsg\n", "https://www.rcsb.org/structure/1HSG",
          "HTTPS://WWW.RCSB.ORG/structure/1HSG", "http://rcsb.org/structure/1hsg?x=1#here",
          "https://www.rcsb.org/3d-view/1HSG/1",
          "https://www.rcsb.org/pdb/explore.do?structureId=1HSG",
          "https://files.rcsb.org/download/1hsg.cif", "https://files.rcsb.org/download/1HSG.cif.gz",
          "https://files.rcsb.org/download/1hsg-assembly1.cif.gz",
          "https://files.wwpdb.org/pub/pdb/data/structures/divided/pdb/hs/pdb1hsg.ent.gz",
          "https://www.ebi.ac.uk/pdbe/entry/pdb/1hsg",
          "https://www.ebi.ac.uk/pdbe/entry/pdb/1hsg/protein/1",
          "https://www.ebi.ac.uk/pdbe/entry-files/download/1hsg_updated.cif",
          "https://pdbj.org/mine/summary/1hsg",
          "https://pdbj.org/rest/newweb/fetch/file?cat=pdb&type=cif&id=1hsg",
          "https://www.rcsb.org/structure/pdb_00001hsg"}) {
        INFO(link);
        CHECK(find_pdb_code(link) == "1hsg");
    }
}

TEST_CASE("other links and texts name no entry", "[download][code]") {
    for (const char* const link :
         {"", "https://", "https://www.rcsb.org", "https://www.rcsb.org/",
          "https://www.rcsb.org/search", "https://www.example.org/structure/1HSG",
          "https://rcsb.org.example.org/structure/1hsg", "https://notrcsb.org/structure/1hsg",
          "https://user@example.org/rcsb.org/1hsg", "ftp://www.rcsb.org/structure/1HSG",
          "www.rcsb.org/structure/1HSG", "file:///folder/1hsg", "1hsg.pdb", "a 1hsg",
          "folder/1hsg"}) {
        INFO(link);
        CHECK_FALSE(find_pdb_code(link));
    }
}

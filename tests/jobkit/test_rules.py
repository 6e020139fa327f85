"""Rules on either database; also tests `jobkit.database.rule_tables`."""

import threading

import pytest

from jobkit.database.session import Database
from jobkit.errors import RuleNotFoundError
from jobkit.rules import Rules
from quadpatch_client.schema import Acceptance, RuleContent


def content(error: float) -> RuleContent:
    return RuleContent(acceptance=Acceptance(max_expected_error=error))


@pytest.fixture
def rules(any_database: Database) -> Rules:
    return Rules(any_database.of("plant-north"))


def test_what_differs_from_the_latest_version_is_the_next_one(rules: Rules) -> None:
    saved = [rules.save("castings", content(error)) for error in (0.1, 0.1, 0.2, 0.1)]
    assert [(rule.version, is_new) for rule, is_new in saved] == [(1, True), (1, False), (2, True), (3, True)]
    assert rules.get("castings", 2).content == content(0.2)
    assert [rules.resolve(reference).version for reference in ("castings", "castings@1")] == [3, 1]
    assert [rule.version for rule in rules.versions("castings", 2).items] == [3, 2]
    assert [rule.version for rule in rules.versions("castings", 2, below=2).items] == [1]


def test_numbers_of_deleted_versions_never_come_back(rules: Rules) -> None:
    rules.save("castings", content(0.1))
    rules.delete("castings")
    for version in (None, 1):
        with pytest.raises(RuleNotFoundError):
            rules.get("castings", version)
    with pytest.raises(RuleNotFoundError):
        rules.delete("castings")
    assert rules.page(10).items == []
    assert rules.save("castings", content(0.1))[0].version == 2
    assert [rule.version for rule in rules.versions("castings", 10).items] == [2]


def test_rules_are_listed_by_name_in_their_latest_version(rules: Rules) -> None:
    for name, error in (("b", 0.1), ("a", 0.1), ("c", 0.1), ("b", 0.2)):
        rules.save(name, content(error))
    page = rules.page(2)
    assert [(rule.name, rule.version) for rule in page.items] == [("a", 1), ("b", 2)]
    rest = rules.page(2, page.next_cursor)
    assert [(rule.name, rule.version) for rule in rest.items] == [("c", 1)]
    assert rest.next_cursor is None


def test_tenants_have_rules_of_their_own(any_database: Database, rules: Rules) -> None:
    rules.save("castings", content(0.1))
    for tenant in ("plant-south", "default"):
        others = Rules(any_database.of(tenant))
        assert others.page(10).items == []
        with pytest.raises(RuleNotFoundError):
            others.get("castings")
        assert others.save("castings", content(0.3))[0].version == 1
    assert rules.get("castings").content == content(0.1)


def test_versions_that_are_saved_at_once_get_numbers_of_their_own(rules: Rules) -> None:
    def save(i: int) -> None:
        rules.save("castings", content(1.0 + i))

    threads = [threading.Thread(target=save, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    versions = rules.versions("castings", 10).items
    assert [rule.version for rule in versions] == [4, 3, 2, 1]
    assert len({rule.content.model_dump_json() for rule in versions}) == 4

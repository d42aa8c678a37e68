"""The server gives a run's data to those who have the link, and nothing else to anybody."""

import json
import threading

import pytest

from porescale.common.core.errors import InputError
from porescale.common.record import snapshots
from porescale.common.record.series import Series
from porescale.common.watch.growing import Growing
from porescale.common.watch.server import Answer, Server
from porescale.common.watch.site import Site, kind_of
from tests.reference.watched import PROGRAM, asked, served, told, toy_run

SECRET = b"a file outside of the run folder"


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A folder with a run in it, a file beside the run, and links in the run that lead to it."""
    made = tmp_path_factory.mktemp("place")
    toy_run(made / "run")
    (made / "secret.csv").write_bytes(b"time (s),a\n0,1\n" + SECRET)
    (made / "run" / "link.csv").symlink_to(made / "secret.csv")
    (made / "run" / "loop.csv").symlink_to(made / "run" / "loop.csv")
    (made / "run" / "up").symlink_to(made)
    return made


@pytest.fixture(scope="module")
def server(place):
    with served(place / "run") as running:
        yield running


def test_the_page_and_its_data_are_served(server, place):
    status, page, headers = asked(server, "")
    assert (status, headers["Content-Type"]) == (200, "text/html; charset=utf-8")
    assert b"<title>run</title>" in page
    assert (
        told(server, "state")["steps"]
        == told(server, "meta")["steps"]
        == told(server, "news")["steps"]
        == [0, 10, 20, 30]
    )
    frame = asked(server, "frame/3")[1]
    assert json.loads(frame[4 : 4 + int.from_bytes(frame[:4], "little")])["step"] == 30
    table = told(server, "table/series")
    assert (table["columns"][0], table["rows"]) == ({"name": "time", "unit": "s"}, 31)
    assert headers["Cache-Control"] == "no-store"
    assert headers["Referrer-Policy"] == "no-referrer"
    assert "porescale" in headers["Server"]
    assert "Python" not in headers["Server"]


@pytest.mark.parametrize(
    "path",
    ["..", "../", "../secret.csv", "../../secret.csv", "..%2fsecret.csv", "%2e%2e/secret.csv", "%2e%2e%2fsecret.csv",
     "%252e%252e%252fsecret.csv", "..%5csecret.csv", "....//secret.csv", "table/../secret", "table/..%2fsecret",
     "table/..%2f..%2fetc%2fpasswd", "table/%2fetc%2fpasswd", "table/link", "table/loop", "table/up%2fsecret",
     "table/.lock", "table/", "table", "table/series/", "up/secret.csv", "card.json", "series.csv", "checkpoint.h5",
     "frame/..%2fcard", "frame/4", "frame/-1", "frame/1e0", "frame/%D9%A1", "frame/99999999999999999999", "frame/",
     "run/run/", "run/../state", "points", "picture/run", "state/", "/state", "//etc/passwd", "%00", "table/series%00",
     "table/%ff", "~root", "C:%5cWindows"],
)  # fmt: skip
def test_nothing_but_what_the_page_asks_for_is_there(server, path):
    status, body, _ = asked(server, f"/{server.token}/{path}")
    assert status == 404
    assert SECRET not in body


@pytest.mark.parametrize(
    "path", ["/", "/state", "//state", "/../state", "/TOKEN", "/TOKENx/", "/x/../TOKEN/", "//TOKEN/"]
)
def test_without_the_token_all_is_refused(server, path):
    path = path.replace("TOKENx", server.token + "x").replace("TOKEN", server.token)
    status, body, _ = asked(server, path)
    assert status == (404 if path == f"/{server.token}" else 200 if path == f"//{server.token}/" else 403)
    assert server.token.encode() not in body or status == 200


def test_tokens_are_long_and_new_each_time(place):
    tokens = {Server(lambda parts: None).token for _ in range(20)}
    assert len(tokens) == 20
    assert min(map(len, tokens)) >= 22  # 128 bits, six a sign


@pytest.mark.parametrize(
    ("host", "status"),
    [("evil.example", 403), ("127.0.0.1.evil.example:80", 403), ("localhost.evil.example", 403), ("0.0.0.0", 403),
     ("", 403), ("[::1]", 403), ("127.0.0.1:80:80", 403), ("localhost", 200), ("LOCALHOST:9000", 200),
     ("127.0.0.1", 200)],
)  # fmt: skip
def test_only_this_machine_may_be_asked_for(server, host, status):
    assert asked(server, "state", host=host)[0] == status


def test_a_proxys_form_of_a_path_is_not_answered(server):
    assert asked(server, f"http://127.0.0.1/{server.token}/state")[0] == 404


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "PATCH", "OPTIONS", "TRACE", "CONNECT", "FOO"])
def test_only_reading_is_allowed(server, method):
    status, _, headers = asked(server, "state", method)
    assert (status, headers["Allow"]) == (405, "GET, HEAD")


def test_head_is_get_without_a_body(server):
    status, body, headers = asked(server, "frame/0", "HEAD")
    assert (status, body) == (200, b"")
    assert int(headers["Content-Length"]) == len(asked(server, "frame/0")[1])


def test_it_listens_at_127_0_0_1_alone(server):
    assert server.server_address[0] == "127.0.0.1"
    assert server.link.startswith("http://127.0.0.1:")


def test_snapshots_and_rows_appear_as_they_are_written(tmp_path):
    toy_run(tmp_path)
    last = Growing(tmp_path, PROGRAM).run().snapshot(-1)
    with served(tmp_path) as server:
        assert told(server, "state")["steps"][-1] == 30
        last.step, last.time = 40, 0.04
        snapshots.write_part(tmp_path, last)
        assert told(server, "state")["steps"][-1] == told(server, "news")["steps"][-1] == 40
        assert asked(server, "frame/4")[0] == 200
        series = Series(tmp_path / "series.csv", (tmp_path / "series.csv").stat().st_size)
        series.append({"time (s)": 0.04, "energy (J)": 7.25, "mean (1)": 0.5})
        assert [column[-1] for column in told(server, "table/series")["data"]] == [0.04, 7.25, 0.5]
        assert told(server, "state")["time"] == 0.04
        series.close()


def test_a_damaged_snapshot_is_said(tmp_path):
    toy_run(tmp_path)
    (tmp_path / "fields.vtkhdf").write_bytes(b"nothing of the kind")
    with served(tmp_path) as server:
        status, body, _ = asked(server, "state")
        assert (status, b"damaged" in body) == (409, True)


def test_a_folder_becomes_a_run_while_it_is_watched(tmp_path):
    with served(tmp_path / "run") as server:
        assert told(server, "kind") == "nothing"
        assert b"Nothing is written here yet" in asked(server, "")[1]
        (tmp_path / "run").mkdir()
        assert told(server, "kind") == "nothing"
        toy_run(tmp_path / "run")
        assert told(server, "kind") == "run"
        assert told(server, "state")["outcome"] == "finished"


def test_other_folders_are_refused(tmp_path):
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "file.txt").touch()
    for path in (tmp_path / "other", tmp_path / "other" / "file.txt"):
        with pytest.raises(InputError, match="holds no run and no sweep"):
            kind_of(path)


def test_points_of_a_sweep_and_their_runs(tmp_path):
    for name, rate in (("a=1", "1"), ("b &é", "2.5")):
        toy_run(tmp_path / "sweep" / name, settings=[f"decay.rate={rate}"])
    toy_run(tmp_path / "elsewhere")
    (tmp_path / "sweep" / "link").symlink_to(tmp_path / "elsewhere")
    (tmp_path / "sweep" / "sweep.csv").write_text(
        "name,decay.rate,outcome,energy (J),steps,problem\nb &é,2.5,finished,7.5,30,\n"
    )
    with served(tmp_path / "sweep") as server:
        assert told(server, "kind") == "sweep"
        rows = told(server, "points")
        assert [row["name"] for row in rows] == ["b &é", "a=1"]
        assert [row["values"]["decay.rate"] for row in rows] == [2.5, 1.0]
        assert [row["numbers"] for row in rows] == [{"energy (J)": 7.5}, {}]
        assert rows[1]["state"]["steps"] == [0, 10, 20, 30]
        assert told(server, "run/b%20%26%C3%A9/state")["outcome"] == "finished"
        assert asked(server, "picture/a%3D1")[1].startswith(b"\x89PNG")
        assert b"<title>a=1</title>" in asked(server, "run/a%3D1/")[1]
        for path in ("run/link/state", "run/../state", "run/%2e%2e/state", "run/", "run/a%3D1", "picture/link", "state",
                     "picture/..%2f..%2felsewhere", "run/..%2felsewhere/state"):  # fmt: skip
            assert asked(server, path)[0] == 404, path


def test_answers_wait_for_each_other(tmp_path):
    """HDF5 reads one thing at a time: two answers are never made at once."""
    busy, most = threading.Semaphore(0), []

    def site(parts):
        most.append(server.reading.locked())
        busy.release()
        return Answer(b"")

    server = Server(site)
    with server:
        thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01})
        thread.start()
        with server.reading:
            reader = threading.Thread(target=asked, args=(server, "x"))
            reader.start()
            assert not busy.acquire(timeout=0.1)
        assert busy.acquire(timeout=60)
        reader.join()
        server.shutdown()
        thread.join()
    assert most == [True]


@pytest.mark.parametrize("port", [-1, 65536])
def test_ports_out_of_range_are_refused(port, tmp_path):
    with pytest.raises(InputError, match="out of range"):
        Server(Site(tmp_path, PROGRAM), port)

"""Addresses are read only where that is asked for, whole, and by HTTP alone."""

from __future__ import annotations

import gzip
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import pytest
from click.testing import CliRunner

import tinsmith as ts
from tinsmith.cli import main

ROWS = b"x,y,z\n0,0,5\n4,0,6\n0,3,8.25\n"


class Server(BaseHTTPRequestHandler):
    def do_GET(self):
        self.server.asked.append(self.path)
        name = self.path.rpartition("/")[2]
        content = gzip.compress(ROWS) if name.endswith(".gz") else ROWS
        if name == "none.csv":
            self.send_error(404)
            return
        if name in ("moved.csv", "file.csv"):
            self.send_response(302)
            target = "a.csv" if name == "moved.csv" else "file:///etc/hostname"
            self.send_header("Location", target)
            self.end_headers()
            return
        self.send_response(200)
        self.send_header("Content-Length", str(len(content) + (7 if name == "cut.csv" else 0)))
        self.end_headers()
        self.wfile.write(content)

    def log_message(self, *_):
        pass


@pytest.fixture
def server(monkeypatch):
    for name in ("http_proxy", "HTTP_PROXY", "all_proxy", "ALL_PROXY"):
        monkeypatch.delenv(name, raising=False)
    with ThreadingHTTPServer(("127.0.0.1", 0), Server) as made:
        made.asked = []
        made.address = f"http://127.0.0.1:{made.server_port}"
        threading.Thread(target=made.serve_forever, args=(0.01,), daemon=True).start()
        yield made
        made.shutdown()


@pytest.mark.parametrize("name", ["a.csv", "b.csv.gz", "sub/a.csv?key=1", "moved.csv"])
def test_what_an_address_holds_is_read(server, name):
    survey = ts.read(f"{server.address}/{name}", remote=True)
    assert survey.points.tolist() == [[0, 0, 5], [4, 0, 6], [0, 3, 8.25]]
    assert survey.source == name.rpartition("/")[2].partition("?")[0]


def test_addresses_and_files_are_one_survey(server, tmp_path):
    (tmp_path / "here.csv").write_bytes(b"x,y,z\n9,9,1\n8,9,1\n")
    survey = ts.read([f"{server.address}/a.csv", tmp_path / "here.csv"], remote=True)
    assert len(survey.points) == 5
    assert set(survey.attributes["source_file"].tolist()) == {"a.csv", "here.csv"}


def test_nothing_is_asked_for_without_a_word(server):
    with pytest.raises(ts.ReadError, match="is an address, and only files of this machine"):
        ts.read(f"{server.address}/a.csv")
    result = CliRunner().invoke(main, ["info", f"{server.address}/a.csv"])
    assert result.exit_code == 1
    assert "--remote" in result.stderr
    assert server.asked == []


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("none.csv", r"Cannot read 'http://127.*none\.csv': Not Found"),
        ("cut.csv", r"ended after 27 of 34 bytes"),
        ("file.csv", r"Cannot read .*file\.csv"),
    ],
)
def test_what_does_not_come_whole_is_refused(server, name, words):
    with pytest.raises(ts.ReadError, match=words) as caught:
        ts.read(f"{server.address}/{name}", remote=True)
    assert str(caught.value).endswith(".")


def test_a_server_that_is_not_there():
    with pytest.raises(ts.ReadError, match=r"Cannot read 'http://127\.0\.0\.1:9/a\.csv'"):
        ts.read("http://127.0.0.1:9/a.csv", remote=True)
    with pytest.raises(ts.ReadError, match="is an address"):
        ts.read("ftp://127.0.0.1/a.csv", remote=True)
    with pytest.raises(ts.OptionError, match="True or False"):
        ts.read("a.csv", remote="yes")


def test_errors_name_the_file_of_the_address(server, monkeypatch):
    monkeypatch.setattr(f"{__name__}.ROWS", b"x,y,z\n1,2,three\n4,5,6\n7,8,9\n")
    with pytest.raises(ts.ReadError, match=r"^'bad\.csv'") as caught:
        ts.read(f"{server.address}/bad.csv", remote=True)
    assert "tinsmith-" not in str(caught.value)


def test_the_command_reads_an_address_with_its_flag(server, tmp_path):
    out = tmp_path / "a.ply"
    result = CliRunner().invoke(
        main, ["build", f"{server.address}/a.csv", "--remote", "-o", str(out)]
    )
    assert result.exit_code == 0, result.output
    assert len(ts.read(out).points) == 3

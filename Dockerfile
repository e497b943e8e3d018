# The program `samewhere` in an image of its own, from the Debian package:
#
#   docker build -t samewhere .
#   docker run --rm -v "$PWD:/data" samewhere run FOLDER_OR_VIDEO --out runs/first
#
# `scripts/try-debian bookworm FOLDER docker` runs these lines without a container engine.
FROM debian:bookworm AS build
WORKDIR /samewhere
COPY . .
RUN ./run package

FROM debian:bookworm-slim
COPY --from=build /samewhere/build/package/samewhere_*.deb /tmp/
RUN apt-get update && apt-get install --yes --no-install-recommends /tmp/samewhere_*.deb && rm -rf /tmp/samewhere_*.deb /var/lib/apt/lists/*
RUN samewhere doctor
WORKDIR /data
ENTRYPOINT ["samewhere"]
CMD ["--help"]

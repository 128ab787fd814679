# 한국어

language-name = 한국어

## What visitors read

invite = 살며시 불어 보세요
hold = 길게 누르면 바람이 붑니다
no-breath = 오늘은 불지 마시고 길게 눌러 바람을 보내 주세요
privacy = 마이크는 공기의 흐름만 측정합니다. 아무것도 녹음하지 않습니다.
more = 더 보기
back = 작품으로 돌아가기
aim = 화면을 만지거나 가리키면 바람이 닿을 곳에 고리가 나타납니다
take = 누른 채 끌면 손으로 움직일 수 있습니다
press-twice = 한 번 누르면 바람이 불고 다시 누르면 멈춥니다
dwell-twice = 포인터를 멈추면 바람이 불고, 옮겨서 다시 멈추면 그칩니다
look-round = 둘러보기
look-round-drag = 작품 옆을 끌면 다른 쪽에서 볼 수 있습니다
look-round-press = 작품 옆을 누르면 다른 쪽에서 볼 수 있습니다
large-text = 큰 글씨
high-contrast = 고대비
microphone = 마이크
press-once = 한 번 누르기
dwell = 멈춰서 누르기
less-motion = 움직임 줄이기
read-aloud = 소리 내어 읽기
microphone-off = 마이크가 꺼져 있습니다.
sound-off = 소리가 꺼져 있습니다.
no-sound = 이 작품은 소리가 나지 않습니다.
take-a-rest = 잠시 쉬면서 편하게 숨을 쉬세요.
stay = 계속하려면 만지거나 불어 주세요
stay-touch = 계속하려면 화면을 만져 주세요
cleaning = 화면을 닦고 있습니다

## What is read aloud of buttons that show only a sign

louder = 소리 크게
softer = 소리 작게
next-page = 다음 작품들
previous-page = 이전 작품들
on = 켜짐
off = 꺼짐

## The staff panel: its frame

staff-page-status = 상태
staff-page-exhibits = 작품
staff-page-bodies = 물체
staff-page-wind = 바람
staff-page-sound = 소리
staff-page-parameters = 매개변수
staff-page-microphone = 마이크
staff-page-test = 시험
staff-page-log = 기록
staff-no-pin = PIN이 설정되지 않았습니다. 이 패널은 모두 보여 주지만 아무것도 바꾸지 않습니다. `soffio pin`을 실행하고 출력된 줄을 [staff] 아래에 넣으세요.
staff-saved-in = { $file }에 저장했습니다.
staff-enter-pin = 직원용: PIN을 입력하세요
staff-pin-checking = 확인 중
staff-pin-wrong = { $count ->
   *[other] PIN이 틀렸습니다({ $count }회 연속). { $seconds }초 후에 다시 입력하세요.
}

## Staff: status

staff-clean = 화면 닦기
staff-mute = 음소거
staff-unmute = 소리 켜기
staff-night = 야간
staff-reset = 초기화
staff-reload = 작품 다시 불러오기
staff-open-now = 지금 열기
staff-close-again = 다시 닫기
staff-audio-self-test = 오디오 자가 점검
staff-new-foam = 윈드폼 교체함
staff-new-reference = 새 기준
staff-end = 키오스크 종료
staff-configuration-says = 설정: { $message }
staff-microphone-says = 마이크: { $message }
staff-venue = 미술관
staff-venue-open = 개관
staff-venue-early = 직원이 개관 시간 전에 열었음
staff-venue-closed = 폐관
staff-breath-wanted = 입김
staff-breath-allowed = 허용
staff-breath-off = 사용 안 함: 관람객이 길게 누름
staff-exhibit = 작품
staff-microphone = 마이크
staff-microphone-dual = { $device }, 이중 마이크
staff-device-starting = 시작 중
staff-device-ok = { $name }, { $rate } Hz
staff-device-missing = 없음: { $reason }
staff-device-closed = 닫힘
staff-level = 음량 레벨
staff-level-floor = { $level } dBFS, 배경 소음 { $floor } dBFS
staff-no-signal = 신호 없음
staff-clipping = 클리핑
staff-clips = { $count ->
   *[other] { $count }회, 그중 입김 없이 { $without }회
}
staff-foam = 윈드폼
staff-foam-breaths = { $count ->
   *[other] 입김 { $count }회
}
staff-foam-breaths-of = { $limit ->
   *[other] 입김 { $limit }회 중 { $count }회
}
staff-self-test = 오디오 자가 점검
staff-self-test-none = 아직 실행하지 않음
staff-self-test-when = { $verdict }; { $when }
staff-self-test-good = 윈드폼, 스피커, 마이크가 이전과 같음({ $db } dB)
staff-self-test-learning = 기준 측정 { $number }/{ $count }
staff-self-test-wet-foam = 윈드폼이 젖었거나 먼지가 있음: 높은 소리가 { $db } dB 작음. 윈드폼을 교체하세요.
staff-self-test-blocked = 전체가 { $db } dB 작음: 윈드폼, 장애물, 게인을 확인하세요
staff-self-test-louder = 전체가 { $db } dB 큼: 게인이 올라갔습니다. 의도한 것이면 ‘새 기준’을 누르세요.
staff-self-test-dead = 마이크 신호 없음: 케이블, 스위치, 전원을 확인하세요
staff-self-test-not-detected = 시험음이 들리지 않음: 스피커와 앰프를 확인하세요
staff-self-test-noisy = 주변이 너무 시끄러워 측정하지 못함
staff-self-test-failed = 실행하지 못함: { $reason }
staff-gain-control = 자동 게인 조절
staff-gain-control-detected = 감지됨
staff-gain-control-none = 감지되지 않음
staff-heard = 이곳에서의 감지
staff-heard-of = { $distance } cm에서 입김 { $of }번 중 { $detected }번 감지
staff-heard-unknown = 측정하지 않음: 입김을 열 번 녹음한 뒤 soffio breath fit 실행
staff-gusts = 외풍과 문
staff-gusts-cost = 입김에 { $db } dB 손실
staff-detector = 감지기
staff-detector-state = { $reason }, { $confidence }
staff-breath = 입김
staff-breath-speeds = 감지 { $detected } m/s, 공기 중 { $blown } m/s
staff-reason-no-signal = 신호 없음
staff-reason-settling = 배경 소음 학습 중
staff-reason-quiet = 조용함
staff-reason-voiced = 목소리나 음악
staff-reason-other-sound = 입김과 다름
staff-reason-pending = 입김일 수 있음
staff-reason-blow = 입김
staff-reason-masked = 키오스크 자체의 소리
staff-reason-fault = 잘못된 표본
staff-wind-force = 바람의 힘
staff-attract = 시연
staff-attract-playing = 재생 중
staff-attract-waiting = 대기 중
staff-joint-error = 관절 오차
staff-energy = 에너지
staff-substeps = 하위 단계
staff-impacts = 충돌
staff-faults = 오류
staff-step = 단계
staff-step-time = { $limit } ms 중 { $ms } ms
staff-motion = 운동
staff-motion-changes = { $count ->
   *[other] { $mode }, 변경 { $count }회
}
staff-motion-dynamics = 구속 동역학
staff-motion-procedural = 절차적
staff-motion-position-based = 위치 기반
staff-pointer-grabs = 손으로 잡은 곳
staff-steps-dropped = 빠진 단계
staff-commands-dropped = 빠진 명령
staff-picture = 화면
staff-wind-to-picture = 바람에서 화면까지
staff-graphics = 그래픽
staff-loudspeaker = 스피커
staff-hearing-loop = 청각 보조 루프
staff-step-to-sound = 단계에서 소리까지
staff-sound-delay = { $total } ms: 단계 { $step }, 블록 { $block }, 리미터 { $limiter }, 장치 { $device }
staff-sound-delay-unknown = { $total } ms: 단계 { $step }, 블록 { $block }, 리미터 { $limiter }, 장치 알 수 없음
staff-block = 블록
staff-block-is = { $ms } ms, 설정 { $wanted } ms
staff-block-shorter = { $ms } ms, 설정 { $wanted } ms; 여기서는 audio.block_ms = { $possible }도 가능합니다
staff-block-shortest = { $ms } ms, 설정 { $wanted } ms; 이 장치의 최소는 { $shortest } ms
staff-late-blocks = 늦은 블록
staff-sounds-lost = 빠진 소리
staff-volume = 음량
staff-volume-is = { $db } dB, 관람객 조절 { $steps }
staff-volume-attenuated = { $volume }, { $db } dB 줄임
staff-volume-muted = { $volume }, 음소거
staff-sound-of-the = 소리 모드
staff-sound-day = 주간
staff-sound-night = 야간
staff-sound-by-hours = { $mode }, 시간에 따름
staff-sound-by-staff = { $mode }, 직원이 설정
staff-level-minute = 레벨, 1분
staff-level-day = 레벨, 하루
staff-level-calibrated = { $db } dB(A)
staff-level-uncalibrated = 최대 눈금 기준 { $db } dB(A), 교정 안 됨
staff-level-silent = 무음

## Staff: exhibits

staff-exhibits-order = 관람객에게 작품이 이 순서로 표시됩니다.
staff-save-order = 순서 저장
staff-discard = 취소
staff-no-file = 내장 설정을 쓰고 있습니다. 파일이 없으면 저장할 수 없습니다.
staff-others = 나머지 모두
staff-others-count = 나머지 모두({ $count })
staff-exhibit-missing = { $id }(없거나 불러올 수 없음: 기록 참고)
staff-not-listed = 목록에 없음:

## Staff: bodies and joints

staff-largest-joint-error = 가장 큰 관절 오차
staff-no-data-yet = 아직 시뮬레이션 데이터가 없습니다
staff-joints = 관절: 누르면 그래프를 봅니다
staff-column-body = 물체
staff-column-mass = 질량, g
staff-column-speed = 속력, m/s
staff-column-spin = 회전, rad/s
staff-column-height = 높이, m

## Staff: wind

staff-wind-help = 점마다 바람을 받는 면 조각입니다. 고리는 지금 겨눈 입김의 원뿔 안에 있고 입술에서 보이는 조각을 나타냅니다. 붉을수록 공기가 빠릅니다.
staff-column-surface = 면의 물체
staff-column-hit = 닿음
staff-column-mean = 평균, m/s
staff-column-fastest = 최대, m/s
staff-hit-of = { $count }개 중 { $hit }개
staff-total-force = 바람의 힘 합계: { $newtons } N
staff-source-speed = 입김의 시작 속력: { $speed } m/s

## Staff: sound

staff-nothing-audible = 소리가 나지 않습니다: 음소거 상태이거나 스피커가 없습니다
staff-strike-speed = 타격 속력, m/s
staff-pan = 왼쪽 … 오른쪽
staff-all-timbres = 모든 음색, 각각 시험용 물체로

## Staff: parameters

staff-does-not-load = 저장한 파일을 불러올 수 없어 마지막 정상 버전을 보여 줍니다. 변경을 되돌리거나 고치세요:
staff-parameters-help = { $file }. 숫자를 끌거나 눌러서 입력하세요. 손을 떼면 저장됩니다.
staff-undo = 되돌리기({ $count })
staff-undone = 되돌렸습니다.
staff-find = 찾기
staff-saved-value = 저장함: { $value }.

## Staff: microphone

staff-no-signal-from = 신호 없음; { $device }
staff-level-now = 현재 레벨
staff-level-range = 이 페이지를 연 뒤
staff-from-to = { $low } ~ { $high } dBFS
staff-noise-floor = 배경 소음
staff-breath-at-lips = 입술에서의 입김
staff-microphones = 마이크 수
staff-all-well = 고칠 것이 없습니다.
staff-measure-again = 범위 다시 측정
staff-sensitivity = breath.sensitivity_db: 입김을 얼마나 세게 볼지
staff-calibrate = 입김으로 보정
staff-calibrate-blow = { $count ->
   *[other] 관람객이 서는 곳에서 관람객처럼 마이크에 1~2초 동안 불어 주세요. { $count }회 남았습니다.
}
staff-stop = 중지
staff-calibrated = 보통의 입김이었다면: { $now } dB 대신 { $proposed } dB.
staff-apply = 적용
staff-dismiss = 무시
staff-remedy-gain-control = 자동 게인 조절을 끄세요: 시스템 믹서(“Auto Gain”, “AGC”), 마이크 소프트웨어 또는 장치에서.
staff-remedy-clipping = 클리핑이 생깁니다: 입력 게인을 낮추세요.
staff-remedy-muted = 음소거되어 있습니다: 시스템 믹서에서 입력을 켜세요.
staff-remedy-loud = 조용한 공간치고 큽니다: 입력 게인을 낮추세요.

## Staff: test

staff-glass = 터치 화면
staff-glass-help = { $count ->
   *[other] 한 손가락이나 여러 손가락으로 화면을 누르면 고리가 따라갑니다. 현재 { $count }개.
}
staff-clear-traces = 자국 지우기
staff-display = 디스플레이
staff-display-help = 회색 단계, 가장자리, 불량 화소를 찾는 색의 순서입니다. 누를 때마다 다음으로 넘어갑니다.
staff-show-patterns = 시험 화면 보기
staff-loudspeakers = 스피커
staff-left = 왼쪽
staff-both = 양쪽
staff-right = 오른쪽
staff-decision = 판정
staff-decision-breath = 입김
staff-decision-none = 입김 아님
staff-because = 이유
staff-confidence = 확신도
staff-speed = 속력
staff-grey-steps = 고른 17단계; 검은 곳과 흰 곳에 사각형이 다섯 개씩 보입니다
staff-edges = 네 가장자리에 한 화소 너비의 흰 선; 둥근 원 다섯 개

## Staff: log

staff-log-grave = 경고와 오류만
staff-log-empty = 줄 없음
